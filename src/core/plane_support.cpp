#include "pcl_symmetry/core/plane_support.h"

#include <algorithm>
#include <cmath>

#include "check.h"
#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/core/surface_normals.h"

namespace pcl_symmetry {

std::vector<float> pointSupport(const std::vector<int>& closest, const std::vector<float>& sq_distances,
                                const std::vector<float>& spacing) {
  constexpr float kReach = 1.25f;       // spacings
  constexpr float kLeastReach = 1e-6f;  // of the radius of the points: below it all samples are one
  std::vector<float> support(closest.size());
  for (std::size_t i = 0; i < closest.size(); ++i) {
    const float reach = kReach * spacing[closest[i]];
    const float distance = std::sqrt(sq_distances[i]);
    const float excess = distance <= reach ? 0.0f : (distance - reach) / std::max(reach, kLeastReach);
    support[i] = std::exp(-excess * excess);
  }
  return support;
}

std::vector<float> planeSupport(const PointsRef& points, const PointsRef& samples, const ReflectionPlane& plane,
                                int num_threads) {
  constexpr std::size_t kBlockSize = 4096;
  const BoundingBall ball = boundingBall(samples);
  check(ball.radius > 0.0, "extent of the samples", ball.radius, "> 0");
  const Points surface = normalizePoints(samples, ball.center, ball.radius);
  const auto search = makeFlannSearch(surface);
  const std::vector<float> spacing = localGeometry(surface, *search, kNumSupportNeighbours, num_threads).spacing;
  std::vector<float> support(points.cols());
  parallelRanges(points.cols(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    Points reflected(3, end - begin);
    for (std::size_t i = begin; i < end; ++i)
      reflected.col(i - begin) =
          ((plane.reflect(points.col(i).cast<double>()) - ball.center) / ball.radius).cast<float>();
    std::vector<int> closest;
    std::vector<float> sq_distances;
    search->search(reflected, 1, closest, sq_distances);
    const auto part = pointSupport(closest, sq_distances, spacing);
    std::copy(part.begin(), part.end(), support.begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return support;
}

}  // namespace pcl_symmetry
