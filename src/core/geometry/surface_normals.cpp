#include "core/geometry/surface_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t points_per_block = 512;

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

/// The plane through the neighbors of a position.
struct TangentPlane {
  Eigen::Vector3f normal;      ///< unit; along z where the neighbors show no plane
  Eigen::Vector3f offset_sum;  ///< sum of the neighbors' offsets from the position
  float roughness;             ///< root mean square distance of the neighbors from the plane
};

/// \param neighbors \p count indices of points.
TangentPlane tangentPlane(const Points& points, const Eigen::Vector3f& position, const int* neighbors, int count) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3f offset = points.col(neighbors[k]) - position;
    sum += offset;
    covariance += offset * offset.transpose();
  }
  covariance -= sum * sum.transpose() / static_cast<float>(count);
  Eigen::Vector3f normal = SymmetricEigen<Eigen::Matrix3f>(covariance).eigenvectors().col(0);
  const bool is_usable = std::abs(normal.squaredNorm() - 1.0f) < 0.1f;  // false where one is no number
  const float sq_residual = is_usable ? normal.dot(covariance * normal) : covariance.trace();
  if (!is_usable) normal = Eigen::Vector3f::UnitZ();
  return {normal, sum, std::sqrt(std::max(0.0f, sq_residual) / static_cast<float>(std::max(1, count - 3)))};
}

}  // namespace

LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_neighbors, int num_threads,
                            FoundNeighbors* neighbors) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int count = numToSearch(points.cols(), num_neighbors);
  const std::vector<float> zeros(size, 0.0f);
  LocalGeometry geometry{Points(3, points.cols()), zeros, std::vector<char>(size), {}, zeros};
  geometry.nearest.resize(size);
  if (neighbors) {
    neighbors->indices.resize(size * static_cast<std::size_t>(count));
    neighbors->sq_reach.resize(size);
  }
  parallelRanges(size, points_per_block, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search.search(points.middleCols(begin, end - begin), count, indices, sq_distances);
    for (std::size_t i = begin; i < end; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const int* const nearest = indices.data() + (i - begin) * static_cast<std::size_t>(count);
      if (neighbors) std::copy_n(nearest, count, &neighbors->indices[i * static_cast<std::size_t>(count)]);
      const TangentPlane plane = tangentPlane(points, points.col(column), nearest, count);
      geometry.nearest[i] = witnessesOf(static_cast<int>(i), nearest, count);
      geometry.normals.col(column) = plane.normal;
      geometry.roughness[i] = plane.roughness;
      const double sq_radius = sq_distances[(i - begin + 1) * static_cast<std::size_t>(count) - 1];
      if (neighbors) neighbors->sq_reach[i] = static_cast<float>(sq_radius);
      const double offset = plane.offset_sum.norm() / static_cast<float>(std::max(1, count - 1));
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
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    const TangentPlane plane = tangentPlane(points, positions.col(k), indices.data() + k * count, count);
    geometry.normals.col(k) = plane.normal;
    geometry.roughness.push_back(plane.roughness);
    geometry.spacing.push_back(spacingOf(sq_distances[(k + 1) * count - 1], count));
  }
  return geometry;
}

namespace {

constexpr std::size_t points_of_block = 512;

/// Whether the neighbors of a sample leave a gap in its tangent plane.
bool isAtBorder(int self, const int* neighbors, int count, const Points& samples, const Points& normals) {
  const Eigen::Vector3f n = normals.col(self), u = n.unitOrthogonal(), v = n.cross(u);
  std::array<float, kGeometry.border_neighbors + 1> angles;
  int num_angles = 0, num_off = 0;
  for (int k = 0; k < count; ++k) {
    if (neighbors[k] == self) continue;
    const Eigen::Vector3f difference = samples.col(neighbors[k]) - samples.col(self);
    if (std::abs(n.dot(difference)) > kGeometry.off_plane * difference.norm()) {
      ++num_off;
      continue;
    }
    angles[num_angles++] = std::atan2(v.dot(difference), u.dot(difference));
  }
  if (num_off > kGeometry.max_off_plane || num_angles == 0) return false;
  std::sort(angles.begin(), angles.begin() + num_angles);
  float gap = angles[0] + 2.0f * static_cast<float>(kPi) - angles[num_angles - 1];
  for (int k = 1; k < num_angles; ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
  return gap > kGeometry.border_gap;
}

}  // namespace

std::vector<char> openBorders(const Points& samples, const ClosestPointSearch& search, const Points& normals,
                              int num_threads, const FoundNeighbors* known) {
  const auto size = static_cast<std::size_t>(samples.cols());
  const int count = static_cast<int>(std::min<Eigen::Index>(samples.cols(), kGeometry.border_neighbors + 1));
  const int num_known = known ? std::min(count, static_cast<int>(known->indices.size() / size)) : 0;
  std::vector<char> borders(size);
  parallelRanges(size, points_of_block, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> open, indices;
    std::vector<float> sq_distances;
    // More neighbors only fill gaps, or fold the surface: what is inside by some of them is inside by all.
    for (std::size_t i = begin; i < end; ++i) {
      const auto self = static_cast<int>(i);
      const int* const nearest = known ? known->indices.data() + i * known->indices.size() / size : nullptr;
      if (!known || isAtBorder(self, nearest, num_known, samples, normals)) open.push_back(self);
    }
    search.search(pointsAt(samples, open), count, indices, sq_distances);
    for (std::size_t k = 0; k < open.size(); ++k)
      borders[open[k]] = isAtBorder(open[k], &indices[k * static_cast<std::size_t>(count)], count, samples, normals);
  });
  return borders;
}

std::vector<char> nearBorders(const std::vector<char>& borders, const LocalGeometry& geometry) {
  std::vector<char> near = borders;
  for (int step = 0; step < 2; ++step) {
    const std::vector<char> before = near;
    for (std::size_t i = 0; i < near.size(); ++i)
      for (const int j : geometry.nearest[i]) near[i] |= before[j];
  }
  return near;
}

double shareNearBorders(const std::vector<char>& borders, const LocalGeometry& geometry) {
  const std::vector<char> near = nearBorders(borders, geometry);
  std::size_t num_pairs = 0, num_near = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    num_pairs += geometry.nearest[i].size();
    for (const int j : geometry.nearest[i]) num_near += near[i] || near[j] ? 1 : 0;
  }
  return num_pairs > 0 ? static_cast<double>(num_near) / static_cast<double>(num_pairs) : 0.0;
}

}  // namespace pcl_symmetry
