#include "pcl_symmetry/prst.h"

#include <algorithm>
#include <cmath>

#include "core/base/options.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"

namespace pcl_symmetry {

static_assert(PRSTSignature32768::descriptorSize() == kPRSTSize);
static_assert(PRSDSignature1024::descriptorSize() == kPRSDSize);
static_assert(GEDTSignature32768::descriptorSize() == kGEDTSize);
static_assert(ShapeSignature20736::descriptorSize() == kSignatureSize);

detail::SymmetrySignatures detail::describeBySymmetry(const Points& points, const PRSTParameters& parameters,
                                                      const Visibility* seen) {
  auto options = optionsWith<DescriptorOptions>(parameters.seed, parameters.num_threads);
  options.by_equation_1 = parameters.by_equation_1;
  const Eigen::Isometry3d T_frame_input = descriptorFrame(points, parameters.use_input_axes, seen, options);
  const SymmetryDescriptors all = symmetryDescriptors(points, T_frame_input, options);
  SymmetrySignatures signatures;
  auto& [prst, prsd, gedt] = signatures;
  std::copy(all.prst.begin(), all.prst.end(), prst.prst);
  std::copy(all.prsd.begin(), all.prsd.end(), prsd.prsd);
  std::copy(all.gedt.begin(), all.gedt.end(), gedt.gedt);
  return signatures;
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
