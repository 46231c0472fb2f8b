#include "core/normals/surface_normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kBlockSize = 512;  // points; chosen: smaller blocks cost more calls, larger ones idle threads

// Distance of the neighbours' mean from the sample, in units of r_k, beyond which it lies at a border.
// derived: eight neighbours all around have 0.25 by chance, half a disc has 4 / (3 pi) = 0.42; chosen between them:
// less takes samples inside for borders, more misses borders.
constexpr double kBorderOffset = 0.38;

/// The plane fitted to the neighbours of a point.
struct TangentPlane {
  Eigen::Vector3f normal;
  Eigen::Vector3f offset_sum;  ///< sum of the neighbours' offsets from the point
  float roughness;             ///< root mean square distance of the neighbours from the plane
};

TangentPlane fitTangentPlane(const Points& points, const Eigen::Vector3f& point, const int* neighbours, int count) {
  TangentPlane plane;
  plane.offset_sum.setZero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3f d = points.col(neighbours[k]) - point;
    plane.offset_sum += d;
    squares += d * d.transpose();
  }
  const Eigen::Matrix3f covariance =
      squares - plane.offset_sum * plane.offset_sum.transpose() / static_cast<float>(count);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0);
  const bool usable = normal.allFinite() && std::abs(normal.squaredNorm() - 1.0f) < 0.1f;
  plane.normal = usable ? normal : Eigen::Vector3f(Eigen::Vector3f::UnitZ());
  const float sq_residual = usable ? normal.dot(covariance * normal) : covariance.trace();
  plane.roughness = std::sqrt(std::max(0.0f, sq_residual) / static_cast<float>(std::max(1, count - 3)));
  return plane;
}

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
  parallelRanges(size, kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search.search(points.middleCols(begin, end - begin), count, indices, sq_distances);
    if (neighbours)
      std::copy(indices.begin(), indices.end(),
                neighbours->indices.begin() + static_cast<std::ptrdiff_t>(begin) * count);
    for (std::size_t i = begin; i < end; ++i) {
      const int* nearest = indices.data() + (i - begin) * count;
      geometry.nearest[i] = witnessesOf(static_cast<int>(i), nearest, count);
      const TangentPlane plane = fitTangentPlane(points, points.col(i), nearest, count);
      geometry.normals.col(i) = plane.normal;
      geometry.roughness[i] = plane.roughness;
      const double sq_radius = sq_distances[(i - begin) * count + count - 1];
      if (neighbours) neighbours->sq_reach[i] = static_cast<float>(sq_radius);
      const double offset = plane.offset_sum.norm() / static_cast<float>(std::max(1, count - 1));
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
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const TangentPlane plane = fitTangentPlane(points, places.col(i), indices.data() + i * count, count);
    geometry.normals.col(i) = plane.normal;
    geometry.roughness.push_back(plane.roughness);
    geometry.spacing.push_back(spacingOf(sq_distances[static_cast<std::size_t>(i * count + count - 1)], count));
  }
  return geometry;
}

}  // namespace pcl_symmetry
