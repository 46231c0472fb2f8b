#include "core/geometry/surface_normals.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/curve_order.h"
#include "core/geometry/tangent_planes.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kBlockSize = 512;  // points; chosen: smaller blocks cost more calls, larger ones idle threads

// Distance of the neighbours' mean from the sample, in units of r_k, beyond which it lies at a border.
// derived: eight neighbours all around have 0.25 by chance, half a disc has 4 / (3 pi) = 0.42; chosen between them:
// less takes samples inside for borders, more misses borders.
constexpr double kBorderOffset = 0.38;

/// Number of points to search for: the neighbours and the point itself, as far as there are any.
int numToSearch(Eigen::Index size, int num_neighbours) {
  return static_cast<int>(std::min<Eigen::Index>(size, num_neighbours + 1));
}

/// The closest other points.
/// \param neighbours \p count indices, nearest first, among them \p self.
std::array<int, kNumWitnesses> witnessesOf(int self, const int* neighbours, int count) {
  std::array<int, kNumWitnesses> witnesses;
  witnesses.fill(self);
  for (int k = 0, next = 0; k < count && next < kNumWitnesses; ++k)
    if (neighbours[k] != self) witnesses[next++] = neighbours[k];
  return witnesses;
}

/// Distance between neighbouring samples.
/// \param sq_radius squared distance of the last one of \p count points, the first of which is the sample.
float spacingOf(double sq_radius, int count) {
  return static_cast<float>(std::sqrt(kPi * sq_radius / std::max(1, count - 1)));
}

}  // namespace

LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_neighbours, int num_threads,
                            FoundNeighbours* neighbours) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int count = numToSearch(points.cols(), num_neighbours);
  const std::vector<float> zeros(size, 0.0f);
  LocalGeometry geometry{Points(3, points.cols()), zeros, std::vector<char>(size), {}, zeros};
  geometry.nearest.resize(size);
  if (neighbours) {
    neighbours->indices.resize(size * static_cast<std::size_t>(count));
    neighbours->sq_reach.resize(size);
  }
  const std::vector<int> order = curveOrder(points);  // a search finds the neighbors of near points together
  parallelRanges(size, kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    const Points queries = pointsAt(points, std::vector<int>(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                                             order.begin() + static_cast<std::ptrdiff_t>(end)));
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search.search(queries, count, indices, sq_distances);
    TangentPlanes planes;
    for (std::size_t k = 0; k < end - begin; ++k) {
      const auto i = static_cast<std::size_t>(order[begin + k]);
      const int* nearest = indices.data() + k * static_cast<std::size_t>(count);
      if (neighbours) std::copy_n(nearest, count, &neighbours->indices[i * static_cast<std::size_t>(count)]);
      const std::size_t place = k % TangentPlanes::kMost;
      if (place == 0)
        planes.fit(points, queries.middleCols(k, std::min<std::size_t>(TangentPlanes::kMost, end - begin - k)), nearest,
                   count);
      geometry.nearest[i] = witnessesOf(static_cast<int>(i), nearest, count);
      geometry.normals.col(i) << planes.normal[0][place], planes.normal[1][place], planes.normal[2][place];
      geometry.roughness[i] = planes.roughness[place];
      const Eigen::Vector3f offset_sum(planes.offset_sum[0][place], planes.offset_sum[1][place],
                                       planes.offset_sum[2][place]);
      const double sq_radius = sq_distances[(k + 1) * count - 1];
      if (neighbours) neighbours->sq_reach[i] = static_cast<float>(sq_radius);
      const double offset = offset_sum.norm() / static_cast<float>(std::max(1, count - 1));
      geometry.at_border[i] = offset > kBorderOffset * std::sqrt(sq_radius) ? 1 : 0;
      geometry.spacing[i] = spacingOf(sq_radius, count);
    }
  });
  return geometry;
}

GeometryAtPlaces localGeometryAt(const Points& points, const ClosestPointSearch& search, const Points& places,
                                 int num_neighbours) {
  const int count = numToSearch(points.cols(), num_neighbours);
  std::vector<int> indices;
  std::vector<float> sq_distances;
  search.search(places, count, indices, sq_distances);
  GeometryAtPlaces geometry{Points(3, places.cols()), {}, {}};
  TangentPlanes planes;
  for (Eigen::Index begin = 0; begin < places.cols(); begin += TangentPlanes::kMost) {
    const auto size = std::min<Eigen::Index>(TangentPlanes::kMost, places.cols() - begin);
    planes.fit(points, places.middleCols(begin, size), indices.data() + begin * count, count);
    for (Eigen::Index k = 0; k < size; ++k) {
      geometry.normals.col(begin + k) << planes.normal[0][k], planes.normal[1][k], planes.normal[2][k];
      geometry.roughness.push_back(planes.roughness[k]);
      geometry.spacing.push_back(spacingOf(sq_distances[static_cast<std::size_t>((begin + k + 1) * count - 1)], count));
    }
  }
  return geometry;
}

}  // namespace pcl_symmetry
