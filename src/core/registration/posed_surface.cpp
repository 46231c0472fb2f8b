#include "core/registration/posed_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/statistics.h"
#include "core/geometry/surface_normals.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

std::vector<int> randomOrder(int size, std::uint64_t seed) {
  std::vector<int> order = allIndices(size);
  RandomStream random(seed);
  for (int i = size - 1; i > 0; --i) std::swap(order[i], order[random.below(static_cast<std::uint64_t>(i) + 1)]);
  return order;
}

std::shared_future<ClosestPointGrid> lateGrid(const Points& points, int num_cells) {
  return std::async(std::launch::deferred, [=] { return ClosestPointGrid(points, num_cells); });
}

}  // namespace

PosedSurface::PosedSurface(const PointsRef& input, std::optional<Visibility> seen_space, std::uint64_t seed,
                           int num_threads)
    : points(input),
      order(randomOrder(static_cast<int>(input.cols()), seed)),
      seen(std::move(seen_space)),
      grid(lateGrid(points, kRegistration.cells)),
      search(makeFlannSearch(input)) {
  FoundNeighbors neighbors;
  LocalGeometry geometry = localGeometry(points, *search, num_threads, &neighbors);
  checkCancelled();
  const double typical = median(geometry.spacing);
  spacing = geometry.spacing;
  if (median(geometry.roughness) > kRegistration.max_roughness * typical)
    geometry = localGeometry(points, *search, num_threads, nullptr, kRegistration.num_rough_neighbors);
  checkCancelled();
  normals = std::move(geometry.normals);
  is_oriented = seen && seen->numPictures() == 1;
  if (is_oriented) normals = normalsToward(std::move(normals), points, seen->viewpoint().cast<float>());
  noise = median(std::move(geometry.roughness));
  accuracy = typical + 2.0 * noise;
  borders = std::async(std::launch::deferred, [points = points, normals = normals, search = search, neighbors] {
              return openBorders(points, *search, normals, 1, &neighbors);
            }).share();
}

PosedSurface::PosedSurface(const PointsRef& input, const PointsRef& known_normals, std::optional<Visibility> seen_space)
    : points(input),
      normals(known_normals),
      order(allIndices(input.cols())),
      seen(std::move(seen_space)),
      grid(lateGrid(points, kRegistration.few_cells)) {}

float normalCosine(const PosedSurface& from, const PosedSurface& onto, const Landing& landing, Eigen::Index i) {
  const float cosine = landing.normals.col(i).dot(onto.normals.col(landing.closest[i]));
  return from.is_oriented && onto.is_oriented ? cosine : std::abs(cosine);
}

Landing land(const PosedSurface& from, const PosedSurface& onto, const Eigen::Isometry3d& T_onto_from, int num_points,
             bool exact) {
  const auto size = std::min<Eigen::Index>(num_points, from.points.cols());
  const Eigen::Matrix3f rotation = T_onto_from.linear().cast<float>();
  const Eigen::Vector3f translation = T_onto_from.translation().cast<float>();
  Landing landing;
  landing.images.resize(3, size);
  landing.normals.resize(3, size);
  landing.closest.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    landing.images.col(i) = rotation * from.points.col(from.order[i]) + translation;
    landing.normals.col(i) = rotation * from.normals.col(from.order[i]);
  }
  if (exact) {
    onto.search->search(landing.images, 1, landing.closest, landing.sq_distances);
  } else {
    const ClosestPointGrid& grid = onto.grid.get();
    for (Eigen::Index i = 0; i < size; ++i) landing.closest[i] = grid.closest(landing.images.col(i));
  }
  return landing;
}

}  // namespace pcl_symmetry
