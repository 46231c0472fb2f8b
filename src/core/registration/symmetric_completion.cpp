#include "pcl_symmetry/core/symmetric_completion.h"

#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"

namespace pcl_symmetry {

void CompletionOptions::validate() const {
  check(overlap > 0.0, "overlap", overlap, "> 0");
  check(margin >= 0.0, "margin", margin, ">= 0");
  checkNumThreads(num_threads);
}

std::vector<int> completingPoints(const PointsRef& points, const ReflectionPlane& plane,
                                  const CompletionOptions& options, const Visibility* visibility) {
  options.validate();
  std::vector<int> completing;
  if (points.cols() == 0) return completing;
  const auto search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbors, options.num_threads);
  const Points reflected = reflectedPoints(points, plane);
  std::vector<char> is_completing(static_cast<std::size_t>(points.cols()));
  parallelPoints(is_completing.size(), options.num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> closest;
    std::vector<float> sq_distances;
    search->search(reflected.middleCols(begin, end - begin), 1, closest, sq_distances);
    for (std::size_t i = begin; i < end; ++i) {
      const double spacing = geometry.spacing[closest[i - begin]];
      is_completing[i] =
          std::sqrt(sq_distances[i - begin]) > options.overlap * spacing &&
          !(visibility && visibility->depthBehind(reflected.col(i).cast<double>()) < -options.margin * spacing);
    }
  });
  for (std::size_t i = 0; i < is_completing.size(); ++i)
    if (is_completing[i]) completing.push_back(static_cast<int>(i));
  return completing;
}

}  // namespace pcl_symmetry
