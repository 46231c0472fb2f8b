#include "core/geometry/surface_normals.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/curve_order.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/tangent_planes.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t places_of_block = 512;

/// Number of points to search for: the neighbors and the point itself, as far as there are any.
int numToSearch(Eigen::Index size, int num_neighbors) {
  return static_cast<int>(std::min<Eigen::Index>(size, num_neighbors + 1));
}

/// The closest other points.
/// \param neighbors \p count indices, nearest first, among them \p self.
std::array<int, kNumWitnesses> witnessesOf(int self, const int* neighbors, int count) {
  std::array<int, kNumWitnesses> witnesses;
  witnesses.fill(self);
  for (int k = 0, next = 0; k < count && next < kNumWitnesses; ++k)
    if (neighbors[k] != self) witnesses[next++] = neighbors[k];
  return witnesses;
}

/// Distance between neighboring samples.
/// \param sq_radius squared distance of the last one of \p count points, the first of which is the sample.
float spacingOf(double sq_radius, int count) {
  return static_cast<float>(std::sqrt(kPi * sq_radius / std::max(1, count - 1)));
}

}  // namespace

LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_neighbors, int num_threads,
                            FoundNeighbours* neighbors) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int count = numToSearch(points.cols(), num_neighbors);
  const std::vector<float> zeros(size, 0.0f);
  LocalGeometry geometry{Points(3, points.cols()), zeros, std::vector<char>(size), {}, zeros};
  geometry.nearest.resize(size);
  if (neighbors) {
    neighbors->indices.resize(size * static_cast<std::size_t>(count));
    neighbors->sq_reach.resize(size);
  }
  const std::vector<int> order = curveOrder(points);  // a search finds the neighbors of near points together
  parallelRanges(size, places_of_block, num_threads, [&](std::size_t begin, std::size_t end) {
    const Points queries = pointsAt(points, std::vector<int>(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                                             order.begin() + static_cast<std::ptrdiff_t>(end)));
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search.search(queries, count, indices, sq_distances);
    TangentPlanes planes;
    for (std::size_t k = 0; k < end - begin; ++k) {
      const auto i = static_cast<std::size_t>(order[begin + k]);
      const int* nearest = indices.data() + k * static_cast<std::size_t>(count);
      if (neighbors) std::copy_n(nearest, count, &neighbors->indices[i * static_cast<std::size_t>(count)]);
      const std::size_t position = k % TangentPlanes::most;
      if (position == 0)
        planes.fit(points, queries.middleCols(k, std::min<std::size_t>(TangentPlanes::most, end - begin - k)), nearest,
                   count);
      geometry.nearest[i] = witnessesOf(static_cast<int>(i), nearest, count);
      geometry.normals.col(i) << planes.normal[0][position], planes.normal[1][position], planes.normal[2][position];
      geometry.roughness[i] = planes.roughness[position];
      const Eigen::Vector3f offset_sum(planes.offset_sum[0][position], planes.offset_sum[1][position],
                                       planes.offset_sum[2][position]);
      const double sq_radius = sq_distances[(k + 1) * count - 1];
      if (neighbors) neighbors->sq_reach[i] = static_cast<float>(sq_radius);
      const double offset = offset_sum.norm() / static_cast<float>(std::max(1, count - 1));
      geometry.at_border[i] = offset > kGeometry.border_offset * std::sqrt(sq_radius) ? 1 : 0;
      geometry.spacing[i] = spacingOf(sq_radius, count);
    }
  });
  return geometry;
}

GeometryAtPlaces localGeometryAt(const Points& points, const ClosestPointSearch& search, const Points& positions,
                                 int num_neighbors) {
  const int count = numToSearch(points.cols(), num_neighbors);
  std::vector<int> indices;
  std::vector<float> sq_distances;
  search.search(positions, count, indices, sq_distances);
  GeometryAtPlaces geometry{Points(3, positions.cols()), {}, {}};
  TangentPlanes planes;
  for (Eigen::Index begin = 0; begin < positions.cols(); begin += TangentPlanes::most) {
    const auto size = std::min<Eigen::Index>(TangentPlanes::most, positions.cols() - begin);
    planes.fit(points, positions.middleCols(begin, size), indices.data() + begin * count, count);
    for (Eigen::Index k = 0; k < size; ++k) {
      geometry.normals.col(begin + k) << planes.normal[0][k], planes.normal[1][k], planes.normal[2][k];
      geometry.roughness.push_back(planes.roughness[k]);
      geometry.spacing.push_back(spacingOf(sq_distances[static_cast<std::size_t>((begin + k + 1) * count - 1)], count));
    }
  }
  return geometry;
}

}  // namespace pcl_symmetry
