#include "core/refinement/landing.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace pcl_symmetry {

std::vector<Eigen::Index> FarTest::nearOf(const PointsRef& points, float bound) const {
  const float min_value = std::min(bound, kFarthest);
  const std::ptrdiff_t size = edt_.numCells();
  std::vector<Eigen::Index> near;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() * scale_ + center_ - edt_.origin();
    const Eigen::Array3d cell = x.array() / edt_.cellSize() + 0.5;
    if (!(cell >= 0.0).all() || !(cell < static_cast<double>(size)).all()) continue;
    const Eigen::Array<std::ptrdiff_t, 3, 1> at = cell.cast<std::ptrdiff_t>();
    if (edt_.values()[(at[2] * size + at[1]) * size + at[0]] > min_value) near.push_back(i);
  }
  return near;
}

Landing land(const IspSurface& surface, Points images, double reach, const std::vector<int>* guesses, bool leaves_out) {
  const auto size = static_cast<std::size_t>(images.cols());
  Landing landing;
  landing.images = std::move(images);
  landing.closest.assign(size, -1);
  landing.sq_distances.assign(size, std::numeric_limits<float>::infinity());
  const float bound = surface.far ? surface.far->bound(reach) : 0.0f;
  const bool has_far = surface.far && (leaves_out || FarTest::isExact(bound));
  const auto sq_reach = static_cast<float>(reach * reach);
  parallelPoints(size, surface.num_threads, [&](std::size_t begin, std::size_t end) {
    const auto some = landing.images.middleCols(begin, end - begin);
    std::vector<Eigen::Index> near;  // offsets from begin
    if (has_far) {
      near = surface.far->nearOf(some, bound);
    } else {
      near.resize(end - begin);
      std::iota(near.begin(), near.end(), Eigen::Index{0});
    }
    Points asked(3, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) asked.col(i) = some.col(near[i]);
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
