#include "core/transform/lane_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/simd.h"
#include "core/transform/bundle_kernels.h"

namespace pcl_symmetry {

namespace {

// Of the quintic spline: roots within the unit circle of z^4 + 26 z^3 + 66 z^2 + 26 z + 1.
constexpr double kPoles[2] = {-0.4305753470999738, -0.0430962882032647};
constexpr int reach_of_spline = 12;  // values on each side that a coefficient depends on: pole^13 = 2e-5 is left out
constexpr int num_taps = 6;          // coefficients that a value of quintic splines depends on

/// Weights of the coefficients -2 to 3 in the value at t in [0, 1].
std::array<float, num_taps> weightsAt(double t) {
  const auto spline = [](double x) {
    if (x <= 1.0) return 11.0 / 20.0 - x * x * (1.0 / 2.0 - x * x * (1.0 / 4.0 - x / 12.0));
    if (x <= 2.0) return 17.0 / 40.0 + x * (5.0 / 8.0 - x * (7.0 / 4.0 - x * (5.0 / 4.0 - x * (3.0 / 8.0 - x / 24.0))));
    return std::pow(3.0 - x, 5) / 120.0;
  };
  std::array<float, num_taps> weights;
  for (int k = 0; k < num_taps; ++k) weights[k] = static_cast<float>(spline(std::abs(t - (k - 2))));
  return weights;
}

/// \return weights of values at distances up to reach_of_spline in a coefficient.
std::array<float, reach_of_spline + 1> weightsOfValues() {
  std::array<float, reach_of_spline + 1> weights{};
  for (const double z : kPoles) {
    const double slope = (2.0 * z + 26.0 - 26.0 / (z * z) - 2.0 / (z * z * z)) / 120.0;
    for (int k = 0; k <= reach_of_spline; ++k) weights[k] += static_cast<float>(std::pow(z, k) / (z * slope));
  }
  return weights;
}

PCL_SYMMETRY_MULTIVERSION
void takeLane(const std::int32_t* sums, int size, float* values) {
  for (int s = 0; s < size; ++s) values[s] = 0.0f;
  for (int r = 0; r < kBundleLanes; r += kRowLanes)
    for (int s = 0; s < size; ++s) values[s] += static_cast<float>(sums[s * kBundleLanes + r]);
}

PCL_SYMMETRY_MULTIVERSION
void addLane(const float* values, int size, const float* weights, float* sums) {
  const float w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3], w4 = weights[4], w5 = weights[5];
  for (int s = 0; s < size; ++s) {
    const float* const here = values + s;
    sums[s] += ((w0 * here[-2] + w1 * here[-1]) + (w2 * here[0] + w3 * here[1])) + (w4 * here[2] + w5 * here[3]);
  }
}

}  // namespace

LaneSums::LaneSums(int num_places, double most_ahead)
    : num_places_(num_places),
      margin_(static_cast<int>(std::ceil(most_ahead)) + num_taps),
      sums_(static_cast<std::size_t>(num_places + kPlacesBehind) * kBundleLanes),
      lane_(num_places + 2 * margin_),
      coefficients_(num_places + 2 * reach_of_spline) {}

void LaneSums::bringTogether(double ahead) {
  for (int j = 0; j < kRowLanes; ++j) {
    const double of_lane = (j - 0.5 * (kRowLanes - 1)) * ahead;
    const int shift = static_cast<int>(std::ceil(of_lane));
    takeLane(sums_.data() + j, num_places_, lane_.data() + margin_);
    addLane(lane_.data() + margin_ - shift, num_places_, weightsAt(shift - of_lane).data(),
            coefficients_.data() + reach_of_spline);
  }
  std::fill(sums_.begin(), sums_.end(), 0);
}

float LaneSums::at(std::int64_t s) const {
  static const std::array<float, reach_of_spline + 1> kWeights = weightsOfValues();
  if (s < 0 || s >= num_places_) return 0.0f;
  const float* const here = coefficients_.data() + reach_of_spline + s;
  float value = kWeights[0] * here[0];
  for (int k = 1; k <= reach_of_spline; ++k) value += kWeights[k] * (here[-k] + here[k]);
  return value;
}

void LaneSums::clear() {
  std::fill(coefficients_.begin(), coefficients_.end(), 0.0f);
}

}  // namespace pcl_symmetry
