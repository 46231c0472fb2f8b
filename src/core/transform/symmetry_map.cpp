#include "pcl_symmetry/core/symmetry_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// Whether no neighbor has a greater value; of equal neighbors, the one with the lowest index is the maximum.
bool isLocalMaximum(const SymmetryMap& map, std::size_t index) {
  const float value = map[index];
  return map.grid.visitNeighbors(map.grid.bin(index), [&](std::size_t neighbor) {
    return map[neighbor] < value || (map[neighbor] == value && neighbor > index);
  });
}

/// Sum of the second differences. Planes beyond the ends of r have D = 0.
double laplacian(const SymmetryMap& map, const PlaneGrid::Bin& bin) {
  const auto value = [&](int dt, int dp, int dk) {
    const auto at = map.grid.step(bin, dt, dp, dk);
    return at ? static_cast<double>(map[map.grid.index(*at)]) : 0.0;
  };
  return value(-1, 0, 0) + value(1, 0, 0) + value(0, -1, 0) + value(0, 1, 0) + value(0, 0, -1) + value(0, 0, 1) -
         6.0 * value(0, 0, 0);
}

constexpr std::size_t kStopEvery = 32;  // directions between two checks of the smallest value

/// Coordinates of points, each in an array of its own.
struct PointBlock {
  const float *x, *y, *z;
  int size;
};

/// A direction and its values: the middle of the row is at the center of the grid, its ends are 0.
struct DirectionRow {
  Eigen::Vector3f normal;  ///< its length is one step of the row
  float greatest;
  std::vector<float> values;
};

/// best[i] = max(best[i], value of the row at point i), linear between its entries.
PCL_SYMMETRY_MULTIVERSION
void raise(const PointBlock& points, const DirectionRow& direction, float* best) {
  const float last = static_cast<float>(direction.values.size() - 2), shift = 0.5f * last;
  const float nx = direction.normal[0], ny = direction.normal[1], nz = direction.normal[2];
  const float *const x = points.x, *const y = points.y, *const z = points.z, *const row = direction.values.data();
  const int size = points.size;
  for (int i = 0; i < size; ++i) {
    const float at = std::min(std::max(nx * x[i] + ny * y[i] + nz * z[i] + shift, 0.0f), last);
    const int k = static_cast<int>(at);
    const float value = row[k] + (at - static_cast<float>(k)) * (row[k + 1] - row[k]);
    best[i] = value > best[i] ? value : best[i];
  }
}

/// D along one direction at the bins, and half-way between them by a cubic through four bins. Otherwise a peak between
/// two bins would be cut off, for example the one at the center of the grid.
/// \return 2 num_radius + 4 values: two zeros, bin 0, half-way, bin 1, ..., the last bin, and three zeros.
std::vector<float> refinedRow(const float* values, int num_radius) {
  const auto at = [&](int k) { return k < 0 || k >= num_radius ? 0.0f : values[k]; };
  std::vector<float> row(2 * num_radius + 4, 0.0f);
  for (int k = 0; k < num_radius; ++k) row[2 * k + 2] = values[k];
  for (int k = 0; k + 1 < num_radius; ++k)
    row[2 * k + 3] = std::max(0.0f, (9.0f * (at(k) + at(k + 1)) - at(k - 1) - at(k + 2)) / 16.0f);
  return row;
}

/// \param values rows of num_radius values of D, one for each direction.
/// \param normals unit vectors, one for each direction.
/// \param radius of the grid, input units: r is in [-radius, radius].
/// \param points 3 x N, relative to the center of the grid, input units.
/// \return the greatest value of any direction through each point, at least 0.
std::vector<float> greatestThrough(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals,
                                   int num_radius, double radius, const Points& points, int num_threads) {
  const float steps_per_unit = static_cast<float>(num_radius / radius);
  std::vector<DirectionRow> rows;
  for (std::size_t d = 0; d < normals.size(); ++d) {
    std::vector<float> row = refinedRow(&values[d * num_radius], num_radius);
    const float greatest = *std::max_element(row.begin(), row.end());
    rows.push_back({normals[d] * steps_per_unit, greatest, std::move(row)});
  }
  sortDescending(rows, &DirectionRow::greatest);
  std::vector<float> best(points.cols(), 0.0f);
  parallelPoints(points.cols(), num_threads, [&](std::size_t begin, std::size_t end) {
    const int size = static_cast<int>(end - begin);
    const Eigen::MatrixX3f block = points.middleCols(begin, size).transpose();
    const PointBlock coordinates{block.col(0).data(), block.col(1).data(), block.col(2).data(), size};
    for (std::size_t d = 0; d < rows.size(); ++d) {
      // The remaining directions cannot raise any value.
      if (d % kStopEvery == 0 && rows[d].greatest <= *std::min_element(best.begin() + begin, best.begin() + end)) break;
      raise(coordinates, rows[d], best.data() + begin);
    }
  });
  return best;
}

}  // namespace

void MapSize::validate() const {
  constexpr int max_per_axis = 4096;
  check(num_theta >= 1 && num_theta <= max_per_axis, "num_theta", num_theta, "in [1, 4096]");
  check(num_phi >= 2 && num_phi <= max_per_axis && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 4096]");
  check(num_radius >= 1 && num_radius <= max_per_axis, "num_radius", num_radius, "in [1, 4096]");
}

PlaneGrid::PlaneGrid(const MapSize& size, const Eigen::Vector3d& center, double radius)
    : num_theta_(size.num_theta),
      num_phi_(size.num_phi),
      num_radius_(size.num_radius),
      center_(center),
      radius_(radius) {
  size.validate();
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
  for (int t = 0; t < num_theta_; ++t) {
    const double width = phiStep() * std::sin(theta(t));
    phi_reach_.push_back(std::clamp(static_cast<int>(std::ceil(thetaStep() / width)), 1, num_phi_ / 2));
  }
}

double PlaneGrid::thetaStep() const {
  return 0.5 * kPi / num_theta_;
}
double PlaneGrid::phiStep() const {
  return 2.0 * kPi / num_phi_;
}
double PlaneGrid::radiusStep() const {
  return 2.0 * radius_ / num_radius_;
}

PlaneGrid::Bin PlaneGrid::bin(std::size_t index) const {
  const auto direction = index / num_radius_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_radius_)};
}

Eigen::Vector3d PlaneGrid::normal(int t, int p) const {
  const double across = std::sin(theta(t));
  return {across * std::cos(phi(p)), across * std::sin(phi(p)), std::cos(theta(t))};
}

Eigen::Vector3d PlaneGrid::normal(std::size_t direction) const {
  return normal(static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_));
}

ReflectionPlane PlaneGrid::plane(const Bin& bin) const {
  const Eigen::Vector3d n = normal(bin.theta, bin.phi);
  return ReflectionPlane(n, n.dot(center_) + offset(bin.radius));
}

std::optional<PlaneGrid::Bin> PlaneGrid::find(const ReflectionPlane& plane) const {
  const ReflectionPlane c = plane.canonical();
  const Eigen::Vector3d& n = c.normal();
  const double r = c.offset() - n.dot(center_);
  if (std::abs(r) > radius_) return std::nullopt;
  const double angle = std::atan2(n.y(), n.x());
  const double wrapped = angle < 0.0 ? angle + 2.0 * kPi : angle;
  const double polar = std::atan2(std::hypot(n.x(), n.y()), n.z());
  return Bin{std::clamp(static_cast<int>(polar / thetaStep()), 0, num_theta_ - 1),
             std::clamp(static_cast<int>(wrapped / phiStep()), 0, num_phi_ - 1),
             std::clamp(static_cast<int>((r + radius_) / radiusStep()), 0, num_radius_ - 1)};
}

std::optional<PlaneGrid::Bin> PlaneGrid::step(const Bin& bin, int dt, int dp, int dk) const {
  Bin to{bin.theta + dt, bin.phi + dp, bin.radius + dk};
  if (to.radius < 0 || to.radius >= num_radius_) return std::nullopt;
  if (to.theta < 0) {
    to.theta = -1 - to.theta;
    to.phi += num_phi_ / 2;
  } else if (to.theta >= num_theta_) {
    to.theta = 2 * num_theta_ - 1 - to.theta;
    to.phi += num_phi_ / 2;
    to.radius = num_radius_ - 1 - to.radius;
  }
  to.phi = ((to.phi % num_phi_) + num_phi_) % num_phi_;
  return to;
}

SymmetryMap SymmetryMap::zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method) {
  return {grid, std::vector<float>(grid.size(), 0.0f), method, edt.sigma(), grid.center()};
}

void LocalMaximaOptions::validate() const {
  check(strength >= 0.0 && strength <= 1.0, "strength", strength, "in [0, 1]");
  check(laplacian >= 0.0 && laplacian <= 1.0, "laplacian", laplacian, "in [0, 1]");
}

std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options, int num_threads) {
  options.validate();
  checkNumThreads(num_threads);
  std::vector<LocalMaximum> maxima;
  if (map.empty()) return maxima;
  const std::size_t strongest = map.strongest();
  const double strength = options.strength * map[strongest];
  const double curvature = options.laplacian * -laplacian(map, map.grid.bin(strongest));
  const PlaneGrid& grid = map.grid;
  std::vector<std::vector<LocalMaximum>> rows(grid.numTheta());
  parallelBlocks(rows.size(), num_threads, [&](std::size_t row) {
    const int t = static_cast<int>(row);
    for (int p = 0; p < grid.numPhi(); ++p) {
      const float* const values = &map.values[grid.index({t, p, 0})];
      const double center_offset = grid.normal(t, p).dot(map.center_of_mass - grid.center());
      for (int k = 0; k < grid.numRadius(); ++k) {
        // Most bins are lower than one of their two neighbors along r.
        const float beside = std::max(k > 0 ? values[k - 1] : 0.0f, k + 1 < grid.numRadius() ? values[k + 1] : 0.0f);
        if (values[k] <= 0.0f || values[k] < beside) continue;
        const PlaneGrid::Bin bin{t, p, k};
        const double share = 1.0 - std::abs(grid.offset(k) - center_offset) / grid.radius();
        if (values[k] < strength * share) continue;
        if (!isLocalMaximum(map, grid.index(bin)) || -laplacian(map, bin) < curvature) continue;
        rows[row].push_back({bin, grid.plane(bin), values[k]});
      }
    }
  });
  for (const auto& row : rows) maxima.insert(maxima.end(), row.begin(), row.end());
  sortDescending(maxima, &LocalMaximum::value);
  return maxima;
}

std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const PlaneGrid& grid = map.grid;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t d = 0; d < grid.numDirections(); ++d) normals.push_back(grid.normal(d).cast<float>());
  return greatestThrough(map.values, normals, grid.numRadius(), grid.radius(),
                         normalizePoints(points, grid.center(), 1.0), num_threads);
}

}  // namespace pcl_symmetry
