#include "core/matching/symmetry_descriptor.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/options.h"
#include "core/geometry/point_samples.h"
#include "core/matching/matching_rules.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

namespace {

/// sqrt(max(D, 0)), or PRST of Equation 1, of the planes within distance 1 of the origin.
/// \param num_radius number of bins of r.
std::vector<float> prstOf(const GaussianEdt& edt, int num_radius, const DescriptorOptions& options) {
  const PlaneGrid grid(kDescriptorBins, kDescriptorBins, num_radius, Eigen::Vector3d::Zero(), 1.0);
  std::vector<float> values =
      sampledTransform(edt, grid, {options.num_samples, options.seed, options.num_threads}).values;
  for (float& value : values)
    value = std::sqrt(options.by_equation_1 ? 0.5f * (1.0f + std::max(0.0f, value)) : std::max(0.0f, value));
  return values;
}

}  // namespace

void DescriptorOptions::validate() const {
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  checkNumThreads(num_threads);
}

Eigen::Isometry3d descriptorFrame(const PointsRef& points, bool input_axes, const Visibility* seen,
                                  const DescriptorOptions& options) {
  if (input_axes) return Eigen::Isometry3d(Eigen::Translation3d(-centerOfMass(points)));
  auto frame = optionsWith<FrameOptions>(options.seed, options.num_threads);
  frame.probabilities = frame.rotations = frame.refined = false;
  return symmetryFrame(points, frame, seen).T_canonical_input;
}

SymmetryDescriptors symmetryDescriptors(const PointsRef& points, const Eigen::Isometry3d& T_frame_input,
                                        const DescriptorOptions& options) {
  options.validate();
  checkPoints(points);
  const Eigen::Matrix3Xd moved = T_frame_input * points.cast<double>();
  const double scale = kMatching.described_radius * moved.colwise().norm().mean();
  check(scale > 0.0, "mean distance from the origin", scale, "> 0");
  const Points scaled = (moved / scale).cast<float>();
  SymmetryDescriptors result;
  result.gedt = GaussianEdt(scaled, {kDescriptorBins, 0.0, options.num_threads, 1.0}).values();
  const GaussianEdt edt(scaled, {kMatching.transform_cells, kMatching.transform_sigma, options.num_threads, 1.0});
  result.prst = prstOf(edt, kDescriptorBins, options);
  // A single bin of r is centered on the planes through the origin.
  result.prsd = prstOf(edt, 1, options);
  return result;
}

float sqDistance(const float* a, const float* b, std::size_t size) {
  using Values = Eigen::Map<const Eigen::VectorXf>;
  const auto count = static_cast<Eigen::Index>(size);
  return (Values(a, count) - Values(b, count)).squaredNorm();
}

float planeDescriptorDistance(const float* a, const float* b, std::size_t size) {
  const std::size_t row = size / kDescriptorBins;
  check(row * kDescriptorBins == size, "size", size, "a multiple of the number of bins");
  double sum = 0.0;
  for (std::size_t t = 0; t < kDescriptorBins; ++t)
    sum += std::sin((static_cast<double>(t) + 0.5) * (0.5 * kPi) / kDescriptorBins) *
           sqDistance(a + t * row, b + t * row, row);
  return static_cast<float>(std::sqrt(sum));
}

}  // namespace pcl_symmetry
