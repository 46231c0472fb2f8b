#include "pcl_symmetry/prst.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"

namespace pcl_symmetry {

static_assert(PRSTSignature32768::descriptorSize() == kPRSTSize);
static_assert(PRSDSignature1024::descriptorSize() == kPRSDSize);
static_assert(GEDTSignature32768::descriptorSize() == kGEDTSize);
static_assert(ShapeSignature20736::descriptorSize() == kSignatureSize);

namespace {

SymmetryDescriptors described(const Points& points, const detail::PRSTParameters& parameters, const Visibility* seen) {
  DescriptorOptions options;
  options.by_equation_1 = parameters.by_equation_1;
  options.seed = parameters.seed;
  options.num_threads = parameters.num_threads;
  const Eigen::Isometry3d T_frame_input = descriptorFrame(points, parameters.use_input_axes, seen, options);
  return symmetryDescriptors(points, T_frame_input, options);
}

}  // namespace

void detail::describeBySymmetry(const Points& points, const PRSTParameters& parameters, const Visibility* seen,
                                PRSTSignature32768& descriptor) {
  const std::vector<float> values = described(points, parameters, seen).prst;
  std::copy(values.begin(), values.end(), descriptor.prst);
}

void detail::describeBySymmetry(const Points& points, const PRSTParameters& parameters, const Visibility* seen,
                                PRSDSignature1024& descriptor) {
  const std::vector<float> values = described(points, parameters, seen).prsd;
  std::copy(values.begin(), values.end(), descriptor.prsd);
}

void detail::describeBySymmetry(const Points& points, const PRSTParameters& parameters, const Visibility* seen,
                                GEDTSignature32768& descriptor) {
  const std::vector<float> values = described(points, parameters, seen).gedt;
  std::copy(values.begin(), values.end(), descriptor.gedt);
}

float descriptorDistance(const PRSTSignature32768& a, const PRSTSignature32768& b) {
  return planeDescriptorDistance(a.prst, b.prst, kPRSTSize);
}

float descriptorDistance(const PRSDSignature1024& a, const PRSDSignature1024& b) {
  return planeDescriptorDistance(a.prsd, b.prsd, kPRSDSize);
}

float descriptorDistance(const GEDTSignature32768& a, const GEDTSignature32768& b) {
  return std::sqrt(sqDistance(a.gedt, b.gedt, kGEDTSize));
}

float productDistance(const PRSTSignature32768& prst_a, const GEDTSignature32768& gedt_a,
                      const PRSTSignature32768& prst_b, const GEDTSignature32768& gedt_b) {
  return descriptorDistance(prst_a, prst_b) * descriptorDistance(gedt_a, gedt_b);
}

}  // namespace pcl_symmetry
