#include "pcl_symmetry/prst.h"

#include <pcl/point_types.h>

#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

static_assert(PRSTSignature32768::descriptorSize() == kPRSTSize);
static_assert(PRSDSignature1024::descriptorSize() == kPRSDSize);
static_assert(GEDTSignature32768::descriptorSize() == kGEDTSize);
static_assert(ShapeSignature20736::descriptorSize() == kSignatureSize);

void detail::PRSTParameters::validate() const {
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
  checkNumThreads(num_threads);
}

std::vector<float> detail::describeBySymmetry(const Points& points, const PRSTParameters& parameters,
                                              const Visibility* seen, SymmetryDescriptorKind kind) {
  DescriptorOptions options;
  options.radius = parameters.radius;
  options.by_equation_1 = parameters.by_equation_1;
  options.seed = parameters.seed;
  options.num_threads = parameters.num_threads;
  Eigen::Isometry3d T_frame_input = Eigen::Isometry3d::Identity();
  if (parameters.use_input_axes) {
    T_frame_input.translation() = -centerOfMass(points);
  } else {
    FrameOptions frame;
    frame.probabilities = false;
    frame.seed = parameters.seed;
    frame.turns = false;
    frame.num_threads = parameters.num_threads;
    T_frame_input = symmetryFrame(points, frame, seen).T_canonical_input;
  }
  SymmetryDescriptors all = symmetryDescriptors(points, T_frame_input, options);
  return std::move(kind == SymmetryDescriptorKind::PRST   ? all.prst
                   : kind == SymmetryDescriptorKind::PRSD ? all.prsd
                                                          : all.gedt);
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

template class PRSTEstimation<pcl::PointXYZ>;
template class PRSTEstimation<pcl::PointXYZI>;
template class PRSTEstimation<pcl::PointXYZRGB>;
template class PRSTEstimation<pcl::PointXYZRGBA>;
template class PRSTEstimation<pcl::PointNormal>;
template class PRSTEstimation<pcl::PointXYZRGBNormal>;

}  // namespace pcl_symmetry
