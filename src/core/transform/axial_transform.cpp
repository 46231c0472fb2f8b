#include "pcl_symmetry/core/axial_transform.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/transform/axial_rotations.h"
#include "core/transform/line_sums.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

AxisGrid::AxisGrid(int num_theta, int num_phi, int num_offset, const Eigen::Vector3d& center, double radius)
    : num_theta_(num_theta), num_phi_(num_phi), num_offset_(num_offset), center_(center), radius_(radius) {
  constexpr int most = 1024;                    // 0.1 degrees
  constexpr std::size_t max_bins = 1ull << 28;  // 1 GiB for each fold
  check(num_theta >= 1 && num_theta <= most, "num_theta", num_theta, "in [1, 1024]");
  check(num_phi >= 2 && num_phi <= most && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 1024]");
  check(num_offset >= 1 && num_offset <= most, "num_offset", num_offset, "in [1, 1024]");
  check(size() <= max_bins, "number of bins", size(), "at most 268435456");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

std::size_t AxisGrid::index(const Bin& bin) const {
  const std::size_t direction = static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi;
  return (direction * num_offset_ + bin.v) * num_offset_ + bin.u;
}

AxisGrid::Bin AxisGrid::bin(std::size_t index) const {
  const std::size_t row = index / num_offset_, direction = row / num_offset_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_offset_), static_cast<int>(row % num_offset_)};
}

Eigen::Matrix3d AxisGrid::frame(std::size_t direction) const {
  const double theta = (direction / num_phi_ + 0.5) * 0.5 * kPi / num_theta_;
  const double phi = (direction % num_phi_ + 0.5) * 2.0 * kPi / num_phi_;
  Eigen::Matrix3d frame;
  frame.col(0) << std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta);
  frame.col(1) << -std::sin(phi), std::cos(phi), 0.0;
  frame.col(2) << std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta);
  return frame;
}

Line3d AxisGrid::axis(const Bin& bin) const {
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi);
  return {center_ + offset(bin.u) * axes.col(0) + offset(bin.v) * axes.col(1), axes.col(2)};
}

void AxialTransformOptions::validate() const {
  check(!folds.empty(), "number of folds", folds.size(), ">= 1");
  for (std::size_t i = 0; i < folds.size(); ++i) {
    check(folds[i] == 0 || (folds[i] >= 2 && folds[i] <= 60), "fold", folds[i], "0 or in [2, 60]");
    check(std::count(folds.begin(), folds.end(), folds[i]) == 1, "fold", folds[i], "named once");
  }
  check(num_samples >= 1 && num_samples <= 1'000'000, "num_samples", num_samples, "in [1, 1000000]");
  checkNumThreads(num_threads);
}

namespace {

constexpr std::size_t directions_per_block = 4;

/// The bins of u with u^2 + v^2 <= radius^2.
std::pair<int, int> rowInBall(const AxisGrid& grid, int v) {
  const auto inside = [&](int u) {
    return grid.offset(u) * grid.offset(u) + grid.offset(v) * grid.offset(v) <= grid.radius() * grid.radius();
  };
  int begin = 0;
  while (begin < grid.numOffset() && !inside(begin)) ++begin;
  return {begin, std::max(begin, grid.numOffset() - begin)};
}

/// Adds what one rotation says about all axes of a direction to D, and to F where the table has free space.
/// \param[in,out] sums D, and F, of each fold for all axes of the direction.
void addRotation(LineSums& lines, const GaussianEdt& edt, const AxisGrid& grid, const Eigen::Matrix3d& frame,
                 const AxialRotation& rotation, double scale, const Eigen::Matrix3Xf& samples,
                 std::vector<std::vector<std::vector<float>>>& sums) {
  const Eigen::Matrix3d matrix = Eigen::AngleAxisd(rotation.angle, frame.col(2)).toRotationMatrix();
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - matrix;
  const Eigen::Matrix3Xf moved = matrix.cast<float>() * samples;
  const Eigen::Vector3d center = toCells(edt, grid.center());
  const Eigen::Vector3d step = rest * frame.col(0) * (grid.offsetStep() / edt.cellSize());
  for (int v = 0; v < grid.numOffset(); ++v) {
    const auto [begin, end] = rowInBall(grid, v);
    if (begin == end) continue;
    const Eigen::Vector3d foot = (grid.offset(0) * frame.col(0) + grid.offset(v) * frame.col(1)) / edt.cellSize();
    const LineSums::Totals& totals =
        lines.ofMoved(moved, (rest * (center + foot)).cast<float>(), step.cast<float>(), begin, end);
    const std::size_t row = static_cast<std::size_t>(v) * grid.numOffset();
    for (std::size_t g = 0; g < sums.size(); ++g)
      for (std::size_t i = 0; i < rotation.weights.size(); ++i) {
        if (rotation.weights[i] == 0.0) continue;
        const double weight = scale * rotation.weights[i];
        for (int k = begin; k < end; ++k) sums[g][i][row + k] += static_cast<float>(weight * totals[g][k]);
      }
  }
}

}  // namespace

AxisMap axialTransform(const GaussianEdt& edt, const AxisGrid& grid, const AxialTransformOptions& options,
                       const Visibility* visibility) {
  options.validate();
  const LookupTable table(edt, freeSpace(edt, visibility, options.num_threads), options.num_threads);
  const Eigen::Matrix3Xf samples = centeredSamples(edt, options.num_samples, options.seed, options.num_threads);
  const std::vector<AxialRotation> rotations = rotationsOf(options.folds, visibility != nullptr);
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const std::size_t per_direction = static_cast<std::size_t>(grid.numOffset()) * grid.numOffset();
  AxisMap map{grid, options.folds, {}, std::vector<float>(grid.size(), 0.0f), edt.sigma()};
  map.values.assign(options.folds.size(), map.greatest);
  const auto run = [&](std::size_t begin, std::size_t end) {
    LineSums lines(edt, table, grid.numOffset());
    const std::vector<std::vector<float>> nothing(options.folds.size(), std::vector<float>(per_direction, 0.0f));
    for (std::size_t direction = begin; direction < end; ++direction) {
      std::vector<std::vector<std::vector<float>>> sums(table.numFunctions(), nothing);
      for (const AxialRotation& rotation : rotations)
        addRotation(lines, edt, grid, grid.frame(direction), rotation, scale, samples, sums);
      for (std::size_t i = 0; i < options.folds.size(); ++i) {
        float* const values = map.values[i].data() + direction * per_direction;
        float* const greatest = map.greatest.data() + direction * per_direction;
        for (std::size_t k = 0; k < per_direction; ++k) {
          const float d = sums[0][i][k];
          values[k] = visibility ? static_cast<float>(seenSymmetry(d, sums[1][i][k])) : d;
          greatest[k] = std::max(greatest[k], values[k]);
        }
      }
    }
  };
  parallelRanges(grid.numDirections(), directions_per_block, options.num_threads, run);
  return map;
}

}  // namespace pcl_symmetry
