#include "core/matching/symmetry_descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

// Cells along each side of the distance transform that planes are measured in. chosen: 2 cells to a sigma; half makes
// steps of f visible in D, twice takes eight times the time and memory.
constexpr int kTransformCells = 64;
// Radii of the ball. chosen: planes are told apart by a narrower Gaussian than places; half makes D sensitive to the
// sampling, twice blurs neighbouring planes.
constexpr double kTransformSigma = 1.0 / 16.0;
// Partial sums. chosen: 32 floats are two AVX-512 or four AVX registers and hide the latency of additions; half waits
// for it, twice gains nothing.
constexpr std::size_t kLanes = 32;

PCL_SYMMETRY_MULTIVERSION
float sumOfSquares(const float* a, const float* b, std::size_t size) {
  float sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float difference = a[i + lane] - b[i + lane];
      sums[lane] += difference * difference;
    }
  }
  for (; i < size; ++i) sums[i % kLanes] += (a[i] - b[i]) * (a[i] - b[i]);
  float sum = 0.0f;
  for (const float lane : sums) sum += lane;
  return sum;
}

/// sin(theta) at the centers of the bins of theta.
const std::array<float, kDescriptorBins>& sines() {
  static const std::array<float, kDescriptorBins> values = [] {
    std::array<float, kDescriptorBins> made;
    for (int t = 0; t < kDescriptorBins; ++t)
      made[static_cast<std::size_t>(t)] = static_cast<float>(std::sin((t + 0.5) * (0.5 * kPi) / kDescriptorBins));
    return made;
  }();
  return values;
}

/// sqrt(max(D, 0)) of the planes within distance 1 of the origin.
/// \param num_radius bins of r.
std::vector<float> prstOf(const GaussianEdt& edt, int num_radius, const DescriptorOptions& options) {
  const PlaneGrid grid(kDescriptorBins, kDescriptorBins, num_radius, Eigen::Vector3d::Zero(), 1.0);
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  std::vector<float> values = sampledTransform(edt, grid, sampling).values;
  for (float& value : values) value = std::sqrt(std::max(0.0f, value));
  return values;
}

}  // namespace

void DescriptorOptions::validate() const {
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  checkNumThreads(num_threads);
}

SymmetryDescriptors symmetryDescriptors(const PointsRef& points, const Eigen::Isometry3d& T_frame_input,
                                        const DescriptorOptions& options) {
  options.validate();
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  const Eigen::Matrix3Xd moved = T_frame_input * points.cast<double>();
  const double scale = options.radius * moved.colwise().norm().mean();
  check(scale > 0.0, "mean distance from the origin", scale, "> 0");
  const Points scaled = (moved / scale).cast<float>();
  GaussianEdtOptions edt_options;
  edt_options.radius = 1.0;
  edt_options.num_threads = options.num_threads;
  edt_options.num_cells = kDescriptorBins;
  SymmetryDescriptors result;
  result.gedt = GaussianEdt(scaled, edt_options).values();
  edt_options.num_cells = kTransformCells;
  edt_options.sigma = kTransformSigma;
  const GaussianEdt edt(scaled, edt_options);
  result.prst = prstOf(edt, kDescriptorBins, options);
  // A single bin of r is centered on the planes through the origin.
  result.prsd = prstOf(edt, 1, options);
  return result;
}

float sqDistance(const float* a, const float* b, std::size_t size) {
  return sumOfSquares(a, b, size);
}

float planeDescriptorDistance(const float* a, const float* b, std::size_t size) {
  const std::size_t row = size / kDescriptorBins;
  check(row * kDescriptorBins == size, "size", size, "a multiple of the number of bins");
  float sum = 0.0f;
  for (std::size_t t = 0; t < kDescriptorBins; ++t) sum += sines()[t] * sumOfSquares(a + t * row, b + t * row, row);
  return std::sqrt(sum);
}

}  // namespace pcl_symmetry
