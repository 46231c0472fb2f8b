#include "core/refinement/landing.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

std::vector<int> FarTest::nearOf(const PointsRef& points, double distance, bool leaves_out) const {
  const std::ptrdiff_t size = edt_.numCells();
  // The least f of a cell whose center is this many cells from a point within the distance
  const auto least = [&](double beside) {
    const double reach = (distance * scale_ + (beside + edt_.thinning()) * edt_.cellSize()) / edt_.sigma();
    return reach < kTransform.reach_in_sigmas ? static_cast<float>(std::exp(-reach * reach)) : 0.0f;
  };
  const float at_center = least(0.0), at_corner = least(0.5 * std::sqrt(3.0));
  std::vector<int> near;
  near.reserve(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() * scale_ + center_ - edt_.origin();
    const Eigen::Array3d cell = x.array() / edt_.cellSize() + 0.5;
    float f = 0.0f, bound = at_corner;
    if ((cell >= 0.0).all() && (cell < static_cast<double>(size)).all()) {
      const Eigen::Array<std::ptrdiff_t, 3, 1> at = cell.cast<std::ptrdiff_t>();
      f = edt_.values()[(at[2] * size + at[1]) * size + at[0]];
      if (f > at_corner && f < at_center) bound = least((cell - at.cast<double>() - 0.5).matrix().norm());
    }
    if (f > 0.0f ? f >= bound : !leaves_out && bound == 0.0f) near.push_back(static_cast<int>(i));
  }
  return near;
}

Landing land(const IspSurface& surface, Points images, double reach, const std::vector<int>* guesses, bool leaves_out) {
  const auto size = static_cast<std::size_t>(images.cols());
  Landing landing;
  landing.images = std::move(images);
  landing.closest.assign(size, -1);
  landing.sq_distances.assign(size, std::numeric_limits<float>::infinity());
  const auto sq_reach = static_cast<float>(reach * reach);
  parallelPoints(size, surface.num_threads, [&](std::size_t begin, std::size_t end) {
    const auto some = landing.images.middleCols(begin, end - begin);
    const std::vector<int> near =  // from begin on
        surface.far ? surface.far->nearOf(some, reach, leaves_out) : allIndices(static_cast<Eigen::Index>(end - begin));
    const Points asked = pointsAt(some, near);
    std::vector<int> closest(near.size(), -1);
    std::vector<float> sq_distances;
    if (guesses)
      for (std::size_t i = 0; i < near.size(); ++i) closest[i] = (*guesses)[begin + near[i]];
    surface.search.searchWithin(asked, sq_reach, closest, sq_distances);
    for (std::size_t i = 0; i < near.size(); ++i) {
      landing.closest[begin + near[i]] = closest[i];
      landing.sq_distances[begin + near[i]] = sq_distances[i];
    }
  });
  return landing;
}

}  // namespace pcl_symmetry
