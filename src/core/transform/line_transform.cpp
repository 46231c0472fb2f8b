#include "pcl_symmetry/core/line_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

LineGrid::LineGrid(int num_theta, int num_radius, const Eigen::Vector2d& center, double radius)
    : num_theta_(num_theta), num_radius_(num_radius), center_(center), radius_(radius) {
  check(num_theta >= 1 && num_theta <= 4096, "num_theta", num_theta, "in [1, 4096]");
  check(num_radius >= 1 && num_radius <= 4096, "num_radius", num_radius, "in [1, 4096]");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

double LineGrid::thetaStep() const {
  return kPi / num_theta_;
}
double LineGrid::radiusStep() const {
  return 2.0 * radius_ / num_radius_;
}

LineGrid::Bin LineGrid::bin(std::size_t index) const {
  return {static_cast<int>(index / num_radius_), static_cast<int>(index % num_radius_)};
}

ReflectionLine LineGrid::line(const Bin& bin) const {
  const double angle = theta(bin.theta);
  return {angle, offset(bin.radius) + center_.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)))};
}

std::optional<LineGrid::Bin> LineGrid::step(const Bin& bin, int dt, int dk) const {
  Bin to{bin.theta + dt, bin.radius + dk};
  if (to.radius < 0 || to.radius >= num_radius_) return std::nullopt;
  if (to.theta < 0 || to.theta >= num_theta_) {
    to.theta = (to.theta + num_theta_) % num_theta_;
    to.radius = num_radius_ - 1 - to.radius;
  }
  return to;
}

ReflectionLine::ReflectionLine(double theta, double offset)
    : theta_(theta), offset_(offset), normal_(std::cos(theta), std::sin(theta)) {
  check(std::isfinite(theta), "theta", theta, "finite");
  check(std::isfinite(offset), "offset", offset, "finite");
}

ReflectionLine ReflectionLine::canonical() const {
  const double half_turns = std::floor(theta_ / kPi);
  const double theta = theta_ - half_turns * kPi;
  const double offset = std::fmod(half_turns, 2.0) == 0.0 ? offset_ : -offset_;
  // Just below zero, theta + pi rounds to pi.
  return theta < kPi ? ReflectionLine(theta, offset) : ReflectionLine(0.0, -offset);
}

double ReflectionLine::angleTo(const ReflectionLine& other) const {
  const double cross = normal_.x() * other.normal_.y() - normal_.y() * other.normal_.x();
  return std::atan2(std::abs(cross), std::abs(normal_.dot(other.normal_)));
}

namespace {

/// A cell with f > 0. Its position is in cells from the middle of the grid.
struct WeightedCell {
  float x, y, f;
};

/// The full sum over cells: D = sum f(x) f(gamma x) / |f|^2.
class FullSum {
public:
  explicit FullSum(const GaussianEdt2D& edt)
      : n_(edt.numCells()),
        middle_(0.5f * static_cast<float>(n_ - 1)),
        values_(edt.values()),
        occupied_(values_.size(), 0),
        scale_(1.0 / edt.sqNorm()) {
    for (int y = 0; y < n_; ++y) {
      for (int x = 0; x < n_; ++x) {
        const float f = values_[static_cast<std::size_t>(y) * n_ + x];
        if (f == 0.0f) continue;
        cells_.push_back({static_cast<float>(x) - middle_, static_cast<float>(y) - middle_, f});
        for (int row = std::max(1, y - 2); row <= std::min(n_ - 3, y + 1); ++row)
          for (int column = std::max(1, x - 2); column <= std::min(n_ - 3, x + 1); ++column)
            occupied_[static_cast<std::size_t>(row) * n_ + column] = 1;
      }
    }
  }

  /// Computes D of the lines with a normal at offsets first, first + step, ... from the middle, in cells.
  void accumulate(const Eigen::Vector2d& normal, double first, double step, int num_lines, double* sums) const {
    const auto nx = static_cast<float>(normal.x()), ny = static_cast<float>(normal.y());
    const auto start = static_cast<float>(first), stride = static_cast<float>(step);
    std::fill(sums, sums + num_lines, 0.0);
    for (const WeightedCell& cell : cells_) {
      const float distance = nx * cell.x + ny * cell.y;
      for (int k = 0; k < num_lines; ++k) {
        const float along = 2.0f * (start + stride * static_cast<float>(k) - distance);
        sums[k] += static_cast<double>(cell.f * at(cell.x + along * nx + middle_, cell.y + along * ny + middle_));
      }
    }
    for (int k = 0; k < num_lines; ++k) sums[k] *= scale_;
  }

private:
  /// Weights of four values at -1, 0, 1 and 2 for a place t in [0, 1] (Catmull and Rom). They are wrong by less than a
  /// thousandth of f. Bilinear interpolation would make D greater along rows of cells than between them.
  static std::array<float, 4> cubicWeights(float t) {
    return {0.5f * t * (-1.0f + t * (2.0f - t)), 0.5f * (2.0f + t * t * (-5.0f + 3.0f * t)),
            0.5f * t * (1.0f + t * (4.0f - 3.0f * t)), 0.5f * t * t * (t - 1.0f)};
  }

  /// f between the cells; 0 in the outermost cells.
  /// \param x,y cells from the first cell center.
  float at(float x, float y) const {
    const float last = static_cast<float>(n_);
    if (!(x >= 0.0f && y >= 0.0f && x < last && y < last)) return 0.0f;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const std::size_t index = static_cast<std::size_t>(row) * n_ + column;
    if (!occupied_[index]) return 0.0f;
    const auto across = cubicWeights(x - static_cast<float>(column)), up = cubicWeights(y - static_cast<float>(row));
    float sum = 0.0f;
    for (int j = 0; j < 4; ++j) {
      const float* const f = &values_[index - n_ - 1] + static_cast<std::size_t>(j) * n_;
      sum += up[j] * (across[0] * f[0] + across[1] * f[1] + across[2] * f[2] + across[3] * f[3]);
    }
    return sum;
  }

  int n_;
  float middle_;
  const std::vector<float>& values_;
  std::vector<char> occupied_;  // 1 for squares between cells that are interpolated from any f > 0
  double scale_;
  std::vector<WeightedCell> cells_;
};

Eigen::Vector2d middleOf(const GaussianEdt2D& edt) {
  return edt.origin() + Eigen::Vector2d::Constant(0.5 * (edt.numCells() - 1) * edt.cellSize());
}

double symmetryAt(const FullSum& sum, const GaussianEdt2D& edt, const ReflectionLine& line) {
  double value = 0.0;
  sum.accumulate(line.normal(), -line.signedDistance(middleOf(edt)) / edt.cellSize(), 0.0, 1, &value);
  return value;
}

bool isLocalMaximum(const LineMap& map, const LineGrid::Bin& bin) {
  const std::size_t index = map.grid.index(bin);
  for (int dt = -1; dt <= 1; ++dt) {
    for (int dk = -1; dk <= 1; ++dk) {
      const auto to = map.grid.step(bin, dt, dk);
      if (!to || map.grid.index(*to) == index) continue;
      const std::size_t neighbor = map.grid.index(*to);
      if (map[neighbor] > map[index] || (map[neighbor] == map[index] && neighbor < index)) return false;
    }
  }
  return true;
}

/// Sum of the second differences (Section 4.4). D is taken as 0 beyond the ends of r.
double laplacian(const LineMap& map, const LineGrid::Bin& bin) {
  const auto value = [&](int dt, int dk) {
    const auto at = map.grid.step(bin, dt, dk);
    return at ? static_cast<double>(map[map.grid.index(*at)]) : 0.0;
  };
  return value(-1, 0) + value(1, 0) + value(0, -1) + value(0, 1) - 4.0 * value(0, 0);
}

/// Climbs to the maximum of D by a compass search over theta and r about the center of the grid.
LineMaximum climb(const FullSum& sum, const GaussianEdt2D& edt, const LineGrid& grid, const ReflectionLine& start) {
  const Eigen::Vector2d about = grid.center();
  const auto lineAt = [&](double theta, double r) {
    return ReflectionLine(theta, r + about.dot(Eigen::Vector2d(std::cos(theta), std::sin(theta))));
  };
  double theta = start.theta(), r = -start.signedDistance(about);
  double value = symmetryAt(sum, edt, start);
  for (double share = kTransform.first_line_step; share > kTransform.last_line_step; share *= 0.5) {
    for (int move = 0; move < kTransform.max_line_moves; ++move) {
      double best_theta = theta, best_r = r;
      for (const auto& [dt, dr] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
        const double to_theta = theta + share * dt * grid.thetaStep(), to_r = r + share * dr * grid.radiusStep();
        const double to_value = symmetryAt(sum, edt, lineAt(to_theta, to_r));
        if (to_value <= value) continue;
        value = to_value;
        best_theta = to_theta;
        best_r = to_r;
      }
      if (best_theta == theta && best_r == r) break;
      theta = best_theta;
      r = best_r;
    }
  }
  return {lineAt(theta, r).canonical(), value};
}

}  // namespace

LineMap lineTransform(const GaussianEdt2D& edt, const LineGrid& grid, const Eigen::Vector2d& center_of_mass,
                      int num_threads) {
  LineMap map;
  map.grid = grid;
  map.sigma = edt.sigma();
  map.center_of_mass = center_of_mass;
  map.values.resize(grid.size());
  const FullSum sum(edt);
  const Eigen::Vector2d shift = (grid.center() - middleOf(edt)) / edt.cellSize();
  parallelBlocks(grid.numTheta(), num_threads, [&](std::size_t t) {
    const double theta = grid.theta(static_cast<int>(t));
    const Eigen::Vector2d normal(std::cos(theta), std::sin(theta));
    std::vector<double> sums(grid.numRadius());
    sum.accumulate(normal, normal.dot(shift) + grid.offset(0) / edt.cellSize(), grid.radiusStep() / edt.cellSize(),
                   grid.numRadius(), sums.data());
    std::copy(sums.begin(), sums.end(), map.values.begin() + t * grid.numRadius());
  });
  return map;
}

std::vector<LineMaximum> findLineMaxima(const GaussianEdt2D& edt, const LineMap& map, const LocalMaximaOptions& options,
                                        int num_threads) {
  options.validate();
  checkNumThreads(num_threads);
  if (map.empty()) return {};
  const LineGrid& grid = map.grid;
  const std::size_t strongest = map.strongest();
  const double strength = options.strength * map[strongest];
  const double curvature = options.laplacian * -laplacian(map, grid.bin(strongest));
  std::vector<LineGrid::Bin> bins;
  for (std::size_t index = 0; index < grid.size(); ++index) {
    const LineGrid::Bin bin = grid.bin(index);
    const double share = 1.0 - std::abs(grid.line(bin).signedDistance(map.center_of_mass)) / grid.radius();
    if (map[index] <= 0.0f || map[index] < strength * share) continue;
    if (isLocalMaximum(map, bin) && -laplacian(map, bin) >= curvature) bins.push_back(bin);
  }
  const FullSum sum(edt);
  std::vector<LineMaximum> maxima(bins.size());
  parallelBlocks(bins.size(), num_threads,
                 [&](std::size_t i) { maxima[i] = climb(sum, edt, grid, grid.line(bins[i])); });
  std::stable_sort(maxima.begin(), maxima.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  return maxima;
}

}  // namespace pcl_symmetry
