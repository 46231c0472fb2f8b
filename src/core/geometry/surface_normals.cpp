#include "core/geometry/surface_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/small_motion.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// Number of points to search for: the neighbors and the point itself, as far as there are any.
int numToSearch(Eigen::Index size, int num_neighbors) {
  return static_cast<int>(std::min<Eigen::Index>(size, num_neighbors + 1));
}

/// The closest other points.
/// \param neighbors \p count indices, nearest first, among them \p self.
std::array<int, kNumDiscNeighbors> discNeighborsOf(int self, const int* neighbors, int count) {
  std::array<int, kNumDiscNeighbors> disc_neighbors;
  disc_neighbors.fill(self);
  for (int k = 0, next = 0; k < count && next < kNumDiscNeighbors; ++k)
    if (neighbors[k] != self) disc_neighbors[next++] = neighbors[k];
  return disc_neighbors;
}

/// Distance between neighboring samples.
/// \param sq_radius squared distance of the last of \p count points, the first of which is the sample.
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
  Moments offsets;
  for (int k = 0; k < count; ++k) offsets.add(points.col(neighbors[k]) - position);
  const Eigen::Matrix3f covariance = offsets.scatter();
  Eigen::Vector3f normal = SymmetricEigen<Eigen::Matrix3f>(covariance).eigenvectors().col(0);
  const bool is_usable = std::abs(normal.squaredNorm() - 1.0f) < 0.1f;  // false if it is NaN
  const float sq_residual = is_usable ? normal.dot(covariance * normal) : covariance.trace();
  if (!is_usable) normal = Eigen::Vector3f::UnitZ();
  return {normal, offsets.sum, std::sqrt(std::max(0.0f, sq_residual) / static_cast<float>(std::max(1, count - 3)))};
}

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

double weightOf(double miss) {
  const double scaled = miss / kGeometry.normal_miss, sum = 1.0 + scaled * scaled;
  return 1.0 / (sum * sum);
}

/// A motion of space, a rotation and a translation, so that a point x moves by shift + rotation x x.
struct Motion {
  Eigen::Vector3d rotation, shift;

  Eigen::Vector3d velocityAt(const Eigen::Vector3d& x) const { return shift + rotation.cross(x); }
};

/// The motion with a rotation of length one that moves the samples the least along their normals.
Motion slowestAlongNormals(const Matrix6d& sum) {
  Eigen::Matrix3d shifts = sum.bottomRightCorner<3, 3>();
  shifts.diagonal().array() += kGeometry.translation_ridge * std::max(1e-12, shifts.trace());
  const Eigen::Matrix3d coupling = sum.topRightCorner<3, 3>();
  const Eigen::Matrix3d best_shifts = -solveSymmetric(shifts, Eigen::Matrix3d(coupling.transpose()));
  const Eigen::Matrix3d rotations = sum.topLeftCorner<3, 3>() + coupling * best_shifts;
  const SymmetricEigen<Eigen::Matrix3d> solver(0.5 * (rotations + rotations.transpose()));
  const Eigen::Vector3d rotation = solver.eigenvectors().col(0);
  const Eigen::Vector3d shift = best_shifts * rotation;
  return {rotation, shift - rotation.dot(shift) * rotation};  // without the translation along the axis
}

/// A point of a surface.
struct Oriented {
  Eigen::Vector3d point, normal;
};

std::vector<Oriented> orientedAt(const Points& points, const Points& normals, const std::vector<int>& samples) {
  std::vector<Oriented> oriented;
  oriented.reserve(samples.size());
  for (const int i : samples) oriented.push_back({points.col(i).cast<double>(), normals.col(i).cast<double>()});
  return oriented;
}

/// Moments of the points in each occupied cell. Occupied cells have slots, in the order of their first points.
class CellMoments {
public:
  explicit CellMoments(int num_cells)
      : side_(num_cells + 2), slot_of_cells_(static_cast<std::size_t>(side_) * side_ * side_, -1) {}

  /// \param x position in cells from the corner of the cube.
  /// \return the slot of its cell.
  int add(const Eigen::Vector3d& x) {
    const Eigen::Array3i at = (x.array() + 1.0).max(1.0).min(static_cast<double>(side_ - 2)).cast<int>();
    const int index = (at.z() * side_ + at.y()) * side_ + at.x();
    int& slot = slot_of_cells_[index];
    if (slot < 0) {
      slot = static_cast<int>(occupied_.size());
      occupied_.push_back(index);
      moments_.emplace_back();
    }
    // Relative to the middle of the cube: floats are precise enough there.
    moments_[slot].add((x - Eigen::Vector3d::Constant(0.5 * (side_ - 2))).cast<float>());
    return slot;
  }

  std::size_t numOccupied() const { return occupied_.size(); }

  /// Sum over a cell and its 26 neighbors.
  Moments around(std::size_t slot) const {
    Moments sum;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const int near = slot_of_cells_[occupied_[slot] + (z * side_ + y) * side_ + x];
          if (near >= 0) sum += moments_[near];
        }
    return sum;
  }

private:
  int side_;  // cells along each side, with a border of one empty cell
  std::vector<int> slot_of_cells_;
  std::vector<int> occupied_;  // index of the cell of each slot
  std::vector<Moments> moments_;
};

}  // namespace

LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_threads,
                            FoundNeighbors* neighbors, int num_neighbors) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int count = numToSearch(points.cols(), num_neighbors);
  const std::vector<float> zeros(size, 0.0f);
  LocalGeometry geometry{Points(3, points.cols()), zeros, std::vector<char>(size), {}, zeros};
  geometry.nearest.resize(size);
  if (neighbors) {
    neighbors->indices.resize(size * static_cast<std::size_t>(count));
    neighbors->sq_reach.resize(size);
  }
  parallelPoints(size, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search.search(points.middleCols(begin, end - begin), count, indices, sq_distances);
    for (std::size_t i = begin; i < end; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const int* const nearest = indices.data() + (i - begin) * static_cast<std::size_t>(count);
      if (neighbors) std::copy_n(nearest, count, &neighbors->indices[i * static_cast<std::size_t>(count)]);
      const TangentPlane plane = tangentPlane(points, points.col(column), nearest, count);
      geometry.nearest[i] = discNeighborsOf(static_cast<int>(i), nearest, count);
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

Points normalsToward(Points normals, const PointsRef& points, const Eigen::Vector3f& viewpoint) {
  for (Eigen::Index i = 0; i < normals.cols(); ++i)
    if (normals.col(i).dot(viewpoint - points.col(i)) < 0.0f) normals.col(i) *= -1.0f;
  return normals;
}

GeometryAtPositions localGeometryAt(const Points& points, const ClosestPointSearch& search, const Points& positions,
                                    int num_neighbors) {
  const int count = numToSearch(points.cols(), num_neighbors);
  std::vector<int> indices;
  std::vector<float> sq_distances;
  search.search(positions, count, indices, sq_distances);
  GeometryAtPositions geometry{Points(3, positions.cols()), {}, {}};
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    const TangentPlane plane = tangentPlane(points, positions.col(k), indices.data() + k * count, count);
    geometry.normals.col(k) = plane.normal;
    geometry.roughness.push_back(plane.roughness);
    geometry.spacing.push_back(spacingOf(sq_distances[(k + 1) * count - 1], count));
  }
  return geometry;
}

std::vector<char> openBorders(const Points& samples, const ClosestPointSearch& search, const Points& normals,
                              int num_threads, const FoundNeighbors* known) {
  const auto size = static_cast<std::size_t>(samples.cols());
  const int count = numToSearch(samples.cols(), kGeometry.border_neighbors);
  const int num_known = known ? std::min(count, static_cast<int>(known->indices.size() / size)) : 0;
  std::vector<char> borders(size);
  parallelPoints(size, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> open, indices;
    std::vector<float> sq_distances;
    // More neighbors only fill gaps or fold the surface: points that some neighbors show to be inside are inside by
    // all.
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

Line3d axisOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples) {
  const std::vector<Oriented> oriented = orientedAt(points, normals, samples);
  std::vector<double> weights(oriented.size(), 1.0);
  Motion motion{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()};
  for (int k = 0; k < kGeometry.reweightings; ++k) {
    // Normal equations of the speed of the points along their normals, in the rotation and the translation.
    WeightedProducts products;
    for (std::size_t i = 0; i < oriented.size(); ++i)
      products.add(oriented[i].point.cross(oriented[i].normal), oriented[i].normal, 0.0, weights[i]);
    motion = slowestAlongNormals(products.ofUnknowns());
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const Eigen::Vector3d velocity = motion.velocityAt(oriented[i].point);
      const double lever = std::max(kGeometry.min_lever, velocity.norm());
      weights[i] = weightOf(velocity.dot(oriented[i].normal) / lever) / (lever * lever);
    }
  }
  // The axis consists of the points that the motion does not move.
  return {motion.rotation.cross(motion.shift), motion.rotation};
}

Eigen::Vector3d centerOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples) {
  const std::vector<Oriented> oriented = orientedAt(points, normals, samples);
  std::vector<double> weights(oriented.size(), 1.0);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (int k = 0; k < kGeometry.reweightings; ++k) {
    // The point with the least sum of w |(I - n n^T) (x - center)|^2.
    WeightedProducts products;
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const auto& [x, n] = oriented[i];
      products.add(n, x - n.dot(x) * n, 1.0, weights[i]);
    }
    const WeightedProducts::Matrix sums = products.sums();
    constexpr int last = WeightedProducts::kLast;
    const Eigen::Matrix3d across =
        (sums(last, last) + kGeometry.position_ridge) * Eigen::Matrix3d::Identity() - sums.topLeftCorner<3, 3>();
    const Eigen::Vector3d pull = sums.block<3, 1>(3, last);
    center = solveSymmetric(across, pull);
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const Eigen::Vector3d d = oriented[i].point - center;
      const double lever = std::max(kGeometry.min_lever, d.norm());
      weights[i] = weightOf(d.cross(oriented[i].normal).norm() / lever) / (lever * lever);
    }
  }
  return center;
}

CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells) {
  CellMoments cells(num_cells);
  CellNormals result;
  result.cell_of_points.resize(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    result.cell_of_points[i] = cells.add((points.col(i).cast<double>() - origin) / cell_size);
  result.normals.resize(3, cells.numOccupied());
  result.flatness.setZero(result.normals.cols());
  for (std::size_t c = 0; c < cells.numOccupied(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    result.normals.col(column).setUnit(2);
    const Moments near = cells.around(c);
    if (near.count < kGeometry.fewest_cell_points) continue;
    const SymmetricEigen<Eigen::Matrix3f> axes(near.scatter());
    const Eigen::Vector3f& values = axes.eigenvalues();
    if (!(values[2] > 0.0f) || !axes.eigenvectors().allFinite()) continue;
    result.normals.col(column) = axes.eigenvectors().col(0).normalized();
    result.flatness[column] = std::max(0.0f, (values[1] - values[0]) / values[2]);
  }
  return result;
}

}  // namespace pcl_symmetry
