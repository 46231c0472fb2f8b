#include "core/scan/depth_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/symmetric_solvers.h"
#include "core/scan/scan_rules.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kRowsOfBlock = 8;

bool hasDepth(float depth) {
  return depth > 0.0f && std::isfinite(depth);
}

std::vector<float> inverted(const std::vector<float>& depths) {
  std::vector<float> inverse(depths.size());
  std::transform(depths.begin(), depths.end(), inverse.begin(),
                 [](float depth) { return hasDepth(depth) ? 1.0f / depth : std::numeric_limits<float>::quiet_NaN(); });
  return inverse;
}

/// The inverse depth of a pixel, estimated from its neighbors.
struct Fit {
  float inverse_depth = std::numeric_limits<float>::quiet_NaN();
  float weight = 0.0f;  ///< sum of the weights of the neighbors
};

/// Weighted least squares of a + b du + c dv.
class PixelPlane {
public:
  void add(float du, float dv, float value, float weight) {
    const Eigen::Vector3f row(1.0f, du, dv);
    squares_.noalias() += weight * row * row.transpose();
    right_ += weight * value * row;
  }

  Eigen::Vector3f solve() const {
    // Pixels in one line have no slope across it: a tiny ridge keeps that slope at 0.
    const Eigen::Vector3f ridge = 1e-3f * Eigen::Vector3f(0.0f, 1.0f, 1.0f);
    return solveSymmetric(Eigen::Matrix3f(squares_ + Eigen::Matrix3f(ridge.asDiagonal())), right_);
  }

private:
  Eigen::Matrix3f squares_ = Eigen::Matrix3f::Zero();
  Eigen::Vector3f right_ = Eigen::Vector3f::Zero();
};

class DepthFilter {
public:
  DepthFilter(const DepthImage& image, int radius, double error)
      : width_(image.width),
        height_(image.height),
        radius_(radius),
        error_(static_cast<float>(error)),
        slant_(static_cast<float>(kScan.slant_at_start * image.pixel_angle)),
        inverse_(inverted(image.depths)) {}

  /// \return the filtered depth; NaN for a flying pixel.
  float at(int u, int v) const {
    const float own = inverse_[index(u, v)];
    if (!std::isfinite(own)) return std::numeric_limits<float>::quiet_NaN();
    const Fit fit = fitAt(u, v, own);
    const bool flies = fit.weight < kScan.fewest_neighbors ||
                       !(std::abs(own - fit.inverse_depth) <= kScan.flying_cut * error_) || !(fit.inverse_depth > 0.0f);
    return flies ? std::numeric_limits<float>::quiet_NaN() : 1.0f / fit.inverse_depth;
  }

private:
  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v) * width_ + u; }

  template <typename Visit>
  void around(int u, int v, const Visit& visit) const {
    const int left = std::max(-radius_, -u), right = std::min(radius_, width_ - 1 - u);
    for (int dv = std::max(-radius_, -v); dv <= std::min(radius_, height_ - 1 - v); ++dv) {
      const float* row = &inverse_[index(u, v + dv)];
      for (int du = left; du <= right; ++du)
        if (std::isfinite(row[du])) visit(static_cast<float>(du), static_cast<float>(dv), row[du]);
    }
  }

  Fit fitAt(int u, int v, float own) const {
    const float cut = kScan.surface_cut * error_, slope = slant_ * own;
    PixelPlane start;
    around(u, v, [&](float du, float dv, float value) {
      if (std::abs(value - own) <= cut + slope * (std::abs(du) + std::abs(dv))) start.add(du, dv, value, 1.0f);
    });
    Eigen::Vector3f plane = start.solve();
    Fit fit;
    for (int round = 0; round < kScan.filter_rounds; ++round) {
      PixelPlane next;
      fit = {};
      around(u, v, [&](float du, float dv, float value) {
        const float off = (value - plane[0] - plane[1] * du - plane[2] * dv) / cut;
        if (!(std::abs(off) < 1.0f)) return;
        const float weight = (1.0f - off * off) * (1.0f - off * off);
        next.add(du, dv, value, weight);
        if (du != 0.0f || dv != 0.0f) fit.weight += weight;
      });
      if (fit.weight < kScan.fewest_neighbors) return fit;
      plane = next.solve();
    }
    fit.inverse_depth = plane[0];
    return fit;
  }

  int width_, height_, radius_;
  float error_, slant_;
  std::vector<float> inverse_;
};

/// Standard deviation of an inverse depth, from second differences of pixels that are some columns apart.
double deviationOfBends(const std::vector<float>& inverse, const DepthImage& image, int apart) {
  std::vector<float> bends;
  for (int v = 0; v < image.height; ++v) {
    const float* row = &inverse[static_cast<std::size_t>(v) * image.width];
    for (int u = apart; u + apart < image.width; ++u) {
      const float bend = row[u - apart] - 2.0f * row[u] + row[u + apart];
      if (std::isfinite(bend)) bends.push_back(std::abs(bend));
    }
  }
  if (bends.empty()) return 0.0;
  const auto size = static_cast<std::ptrdiff_t>(std::ceil(kScan.even_share * static_cast<double>(bends.size())));
  std::nth_element(bends.begin(), bends.begin() + size - 1, bends.end());
  double sum = 0.0;
  for (std::ptrdiff_t i = 0; i < size; ++i) sum += static_cast<double>(bends[i]) * bends[i];
  // A second difference has 1 + 4 + 1 times the variance of a pixel.
  return std::sqrt(sum / static_cast<double>(size) / 6.0) / kScan.trimmed_deviation;
}

}  // namespace

double inverseDepthError(const DepthImage& image, int apart) {
  const std::vector<float> inverse = inverted(image.depths);
  const double error = deviationOfBends(inverse, image, apart);
  // Over twice the distance a shape bends four times as much, while errors stay the same.
  const bool is_error = apart > 1 || deviationOfBends(inverse, image, 2) < kScan.max_growth * error;
  return is_error ? error : 0.0;
}

FilteredDepths filterDepths(const DepthImage& image, int radius, int num_threads) {
  FilteredDepths result{image.depths, 0, 0.0};
  for (float& depth : result.depths)
    if (!hasDepth(depth)) depth = std::numeric_limits<float>::quiet_NaN();
  const double error = inverseDepthError(image);
  double sum = 0.0, count = 0.0;
  for (const float depth : result.depths) {
    if (std::isnan(depth)) continue;
    sum += 1.0 / depth;
    count += 1.0;
  }
  // Compares the error of a depth with the size of a pixel, both at the mean inverse depth.
  if (count == 0.0 || error < kScan.min_error * image.pixel_angle * sum / count) return result;
  if (inverseDepthError(image, kScan.window) > kScan.max_own * error) return result;
  result.inverse_error = error;
  const std::vector<float> before = result.depths;
  const DepthFilter filter(image, radius, error);
  parallelRanges(image.height, kRowsOfBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (int u = 0; u < image.width; ++u)
        result.depths[v * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u)] =
            filter.at(u, static_cast<int>(v));
  });
  for (std::size_t i = 0; i < before.size(); ++i)
    result.num_flying += !std::isnan(before[i]) && std::isnan(result.depths[i]) ? 1 : 0;
  return result;
}

double sensorError(const DepthImage& image) {
  const double error = inverseDepthError(image);
  return error > 0.0 ? std::min(kScan.max_shared * error, inverseDepthError(image, kScan.window)) : 0.0;
}

}  // namespace pcl_symmetry
