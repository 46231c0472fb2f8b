#include "core/transform/convolution/lane_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/simd.h"
#include "core/transform/convolution/bundle_kernels.h"

namespace pcl_symmetry {

namespace {

constexpr double kPole = -0.2679491924311227;  // of the cubic spline. derived: sqrt(3) - 2
/// Values on each side that a value of the spline through them depends on. derived: sqrt(3) kPole^9 = 1e-5 is left out
constexpr int kReach = 8;

/// Weights of the coefficients -1 to 2 in the value at t in [0, 1].
std::array<float, 4> weightsAt(float t) {
  const auto near = [](float x) { return (4.0f - 6.0f * x * x + 3.0f * x * x * x) / 6.0f; };
  const auto far = [](float x) { return x * x * x / 6.0f; };
  return {far(1.0f - t), near(t), near(1.0f - t), far(t)};
}

/// \return weights of samples at distances up to kReach in a coefficient.
std::array<float, kReach + 1> weightsOfSamples() {
  std::array<float, kReach + 1> weights;
  for (int k = 0; k <= kReach; ++k) weights[k] = static_cast<float>(std::sqrt(3.0) * std::pow(kPole, k));
  return weights;
}

PCL_SYMMETRY_MULTIVERSION
void takeLane(const std::int32_t* sums, int size, float* values) {
  for (int s = 0; s < size; ++s) values[s] = static_cast<float>(sums[s * kBundleLanes]);
}

PCL_SYMMETRY_MULTIVERSION
void addLane(const float* values, int size, const float* weights, float* sums) {
  const float w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3];
  for (int s = 0; s < size; ++s)
    sums[s] += (w0 * values[s - 1] + w1 * values[s]) + (w2 * values[s + 1] + w3 * values[s + 2]);
}

}  // namespace

LaneSums::LaneSums(int num_places, double most_ahead)
    : num_places_(num_places),
      margin_(static_cast<int>(std::ceil(most_ahead)) + 3),
      sums_(static_cast<std::size_t>(num_places + kPlacesBehind) * kBundleLanes),
      lane_(num_places + 2 * margin_),
      coefficients_(num_places + 2 * kReach) {}

void LaneSums::bringTogether(double ahead) {
  for (int j = 0; j < kBundleLanes; ++j) {
    const double of_lane = (j - 0.5 * (kBundleLanes - 1)) * ahead;
    const int shift = static_cast<int>(std::ceil(of_lane));
    takeLane(sums_.data() + j, num_places_, lane_.data() + margin_);
    addLane(lane_.data() + margin_ - shift, num_places_, weightsAt(static_cast<float>(shift - of_lane)).data(),
            coefficients_.data() + kReach);
  }
  std::fill(sums_.begin(), sums_.end(), 0);
}

float LaneSums::at(std::int64_t s) const {
  static const std::array<float, kReach + 1> kWeights = weightsOfSamples();
  if (s < 0 || s >= num_places_) return 0.0f;
  const float* const here = coefficients_.data() + kReach + s;
  float value = kWeights[0] * here[0];
  for (int k = 1; k <= kReach; ++k) value += kWeights[k] * (here[-k] + here[k]);
  return value;
}

void LaneSums::clear() {
  std::fill(coefficients_.begin(), coefficients_.end(), 0.0f);
}

}  // namespace pcl_symmetry
