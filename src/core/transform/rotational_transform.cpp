#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/transform/sampled_transform.h"
#include "core/transform/transform_rules.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// \return weights of a cubic through four equidistant values, \p t of the way from the second to the third.
std::array<double, 4> cubicWeights(double t) {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0,
          (t + 1.0) * t * (t - 1.0) / 6.0};
}

/// \return the least number of the form 2^k or 3 * 2^k that is no less, for the Fourier transform.
int smoothSize(double min_size) {
  int size = 8;
  while (size < min_size) size = size % 3 == 0 ? size / 3 * 4 : size / 2 * 3;
  return size;
}

/// D of all planes through one point (Figure 4b), namely those that contain a line of direction psi, tilted about it by
/// delta. Lengths are in cells.
class PlanesThroughPoint {
public:
  /// \param axis axis of the grid that the point lies on: normals are cos(delta) e + sin(delta) b, with e along the
  /// axis and b = e x a, where the line in the plane has the direction a = (cos psi, sin psi) in the other two axes.
  /// \param reach distance from the point to the farthest nonzero cell.
  /// \param step distance between the positions at which f is looked up.
  /// \param line_step how far the far end of a plane moves from one line to the next.
  PlanesThroughPoint(const GaussianEdt& edt, int axis, const Eigen::Vector3d& point, double reach, double step,
                     double line_step)
      : edt_(edt), axis_(axis), point_(point), step_(step), rows_(static_cast<int>(std::ceil(reach / step))) {
    num_beta_ = smoothSize(2.0 * sizeOfRow(rows_ - 1));
    num_delta_ = static_cast<int>(std::ceil(kGreatestTilt / kPi * num_beta_)) + 2;
    num_psi_ = static_cast<int>(std::ceil(kPi * reach * std::sin(kGreatestTilt) / line_step));
    of_line_.resize(num_psi_);
  }

  int numLines() const { return num_psi_; }
  bool isMarked(int line) const { return !of_line_[line].empty(); }

  /// Marks the lines that at() will look up.
  void mark(double psi) {
    const int first = firstOf(psi / kPi * num_psi_) - 1;
    for (int k = 0; k < 4; ++k) of_line_[wrapped(first + k).first].resize(1);
  }

  /// Computes D of the planes through a line: f in cylinders about it, each correlated with its reversal by the
  /// squares of its Fourier coefficients.
  void compute(int line) {
    const double psi = line * kPi / num_psi_;
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis_),
                          a = std::cos(psi) * Eigen::Vector3d::Unit((axis_ + 1) % 3) +
                              std::sin(psi) * Eigen::Vector3d::Unit((axis_ + 2) % 3),
                          b = e.cross(a), middle = Eigen::Vector3d::Constant(middleCell(edt_)) - point_;
    const double radius = middleCell(edt_), along = a.dot(middle);
    Eigen::FFT<float> fft;
    fft.SetFlag(Eigen::FFT<float>::HalfSpectrum);
    std::vector<std::complex<float>> coefficients(num_beta_ / 2 + 1);
    std::vector<std::complex<double>> sums(num_beta_ / 2 + 1);
    std::vector<float> row;
    const double across = std::hypot(e.dot(middle), b.dot(middle)), toward = std::atan2(b.dot(middle), e.dot(middle));
    for (double h = -radius; h < radius; h += step_) {
      const double disc = std::sqrt(radius * radius - h * h);  // where f is not 0 at this height
      for (int k = 0; k < rows_; ++k) {
        const double rho = (k + 0.5) * step_;
        if (std::abs(across - rho) >= disc) continue;
        const int size = sizeOfRow(k);
        row.assign(size, 0.0f);
        const double cosine = (across * across + rho * rho - disc * disc) / (2.0 * across * rho);
        const double half = cosine > -1.0 ? std::acos(std::min(1.0, cosine)) : kPi;
        const Eigen::Vector3d center = point_ + (along + h) * a;
        const int first = static_cast<int>(std::ceil((toward - half) / (2.0 * kPi) * size)),
                  last = static_cast<int>(std::floor((toward + half) / (2.0 * kPi) * size));
        for (int i = first; i <= std::min(last, first + size - 1); ++i) {
          const double alpha = 2.0 * kPi * i / size;
          row[(i % size + size) % size] =
              static_cast<float>(edt_.atCell(center + rho * (std::cos(alpha) * e + std::sin(alpha) * b)));
        }
        fft.fwd(coefficients.data(), row.data(), size);
        for (int i = 0; i < size / 2; ++i)
          sums[i] += rho / size / size * std::complex<double>(coefficients[i] * coefficients[i]);
      }
    }
    std::copy(sums.begin(), sums.end(), coefficients.begin());
    std::vector<float> correlation(num_beta_);
    fft.inv(correlation.data(), coefficients.data(), num_beta_);
    const double volume = 2.0 * kPi * step_ * step_ * num_beta_ / edt_.sqNorm();
    of_line_[line].resize(2 * num_delta_ + 1);
    for (int i = -num_delta_; i <= num_delta_; ++i)
      of_line_[line][i + num_delta_] = static_cast<float>(volume * correlation[num_beta_ / 2 + i]);
  }

  /// \return D by cubic interpolation; the lines around psi have been computed.
  double at(double psi, double delta) const {
    const double line = psi / kPi * num_psi_, tilt = delta / kPi * num_beta_;
    const int first = firstOf(line);
    const std::array<double, 4> of_line = cubicWeights(line - first);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      const auto [index, sign] = wrapped(first - 1 + k);
      const double position = sign * tilt;
      const int below = firstOf(position);
      const std::array<double, 4> weights = cubicWeights(position - below);
      sum += of_line[k] * std::inner_product(weights.begin(), weights.end(),
                                             of_line_[index].begin() + (below - 1 + num_delta_), 0.0);
    }
    return sum;
  }

private:
  static constexpr double kGreatestTilt = 0.9553166181245093;  // acos(1 / sqrt(3)), from the nearest axis

  static int firstOf(double position) { return static_cast<int>(std::floor(position)); }
  int sizeOfRow(int k) const { return smoothSize(2.0 * kPi * (k + 0.5)); }
  /// The same line half a turn on: b, and with it delta, change their sign.
  std::pair<int, int> wrapped(int line) const {
    return line < 0          ? std::pair(line + num_psi_, -1)
           : line < num_psi_ ? std::pair(line, 1)
                             : std::pair(line - num_psi_, -1);
  }

  const GaussianEdt& edt_;
  int axis_;
  Eigen::Vector3d point_;
  double step_;
  int rows_;
  int num_psi_, num_beta_, num_delta_;
  std::vector<std::vector<float>> of_line_;
};

/// Where the value of a bin of the grid is looked up.
struct BinLookUp {
  std::size_t bin;
  double position;  ///< intersection of its plane with the axis, in points from the first
  double psi, delta;
};

/// Sets the values of the planes whose normals lie closest to one axis of the grid: each intersects it in a point.
/// \param bins bins that are computed.
/// \param step distance between points on an axis, and between planes of neighboring lines at the far end of the shape,
/// cells.
void computeAboutAxis(int axis, const GaussianEdt& edt, const PlaneGrid& grid,
                      const RotationalTransformOptions& options, const std::vector<std::size_t>& bins, double step,
                      std::vector<float>& values) {
  const Eigen::Vector3d center = (grid.center() - edt.origin()) / edt.cellSize();
  const int half = static_cast<int>(std::ceil(std::sqrt(3.0) * grid.radius() / edt.cellSize() / step)) + 2;
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(middleCell(edt));
  std::vector<PlanesThroughPoint> points;
  for (int i = -half; i <= half; ++i) {
    const Eigen::Vector3d point = center + i * step * Eigen::Vector3d::Unit(axis);
    points.emplace_back(edt, axis, point, (point - middle).norm() + middleCell(edt),
                        options.spacing * edt.sigma() / edt.cellSize(), step);
  }
  std::vector<BinLookUp> look_ups;
  for (const std::size_t bin : bins) {
    const PlaneGrid::Bin position = grid.bin(bin);
    Eigen::Vector3d n = grid.normal(position.theta, position.phi);
    int nearest;
    n.cwiseAbs().maxCoeff(&nearest);
    if (nearest != axis) continue;
    double offset = grid.offset(position.radius) / edt.cellSize();
    if (n[axis] < 0.0) n = -n, offset = -offset;
    const double x = n[(axis + 1) % 3], y = n[(axis + 2) % 3];
    double psi = std::atan2(-x, y), delta = std::acos(std::min(1.0, n[axis]));  // b = (-sin psi, cos psi)
    if (psi < 0.0) psi += kPi, delta = -delta;
    if (psi >= kPi) psi -= kPi, delta = -delta;
    look_ups.push_back({bin, offset / n[axis] / step + half, psi, delta});
    for (int k = 0; k < 4; ++k)
      points[static_cast<std::size_t>(std::floor(look_ups.back().position)) - 1 + k].mark(psi);
  }
  std::vector<std::pair<PlanesThroughPoint*, int>> lines;
  for (PlanesThroughPoint& point : points)
    for (int line = 0; line < point.numLines(); ++line)
      if (point.isMarked(line)) lines.emplace_back(&point, line);
  parallelBlocks(lines.size(), options.num_threads, [&](std::size_t i) { lines[i].first->compute(lines[i].second); });
  for (const BinLookUp& look_up : look_ups) {
    const int first = static_cast<int>(std::floor(look_up.position));
    const std::array<double, 4> weights = cubicWeights(look_up.position - first);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += weights[k] * points[first - 1 + k].at(look_up.psi, look_up.delta);
    values[look_up.bin] = static_cast<float>(sum);
  }
}

}  // namespace

void RotationalTransformOptions::validate() const {
  check(spacing > 0.0 && spacing <= 1.0, "spacing", spacing, "in (0, 1]");
  check(refined_share >= 0.0 && refined_share <= 1.0, "refined_share", refined_share, "in [0, 1]");
  checkNumThreads(num_threads);
}

SymmetryMap rotationalTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                const RotationalTransformOptions& options) {
  options.validate();
  SymmetryMap map = SymmetryMap::zero(edt, grid, TransformMethod::Rotational);
  const auto compute = [&](const std::vector<std::size_t>& of, double step) {
    for (int axis = 0; axis < 3; ++axis) computeAboutAxis(axis, edt, grid, options, of, step, map.values);
  };
  std::vector<std::size_t> bins(grid.size());
  std::iota(bins.begin(), bins.end(), std::size_t{0});
  if (options.refined_share < 1.0) {
    compute(bins, kTransform.coarse_pivot_step);
    const auto num_refined = static_cast<std::ptrdiff_t>(options.refined_share * static_cast<double>(bins.size()));
    std::nth_element(bins.begin(), bins.begin() + num_refined, bins.end(), [&](std::size_t i, std::size_t j) {
      return std::pair(map.values[j], i) < std::pair(map.values[i], j);
    });
    bins.resize(num_refined);
  }
  compute(bins, kTransform.pivot_step);
  return map;
}

}  // namespace pcl_symmetry
