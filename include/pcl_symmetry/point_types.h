/// Descriptors as PCL points, so that PCD files hold them.
#pragma once

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include "core/descriptors/shape_signature.h"
#include "core/descriptors/symmetry_descriptor.h"

namespace pcl_symmetry {

/// The planar-reflective symmetry transform of a whole cloud, see SymmetryDescriptors::prst.
struct PRSTSignature32768 {
  float prst[32768] = {};
  static constexpr int descriptorSize() { return 32768; }
};
static_assert(PRSTSignature32768::descriptorSize() == kPRSTSize);

/// The symmetry transform of planes through the center alone, see SymmetryDescriptors::prsd.
struct PRSDSignature1024 {
  float prsd[1024] = {};
  static constexpr int descriptorSize() { return 1024; }
};
static_assert(PRSDSignature1024::descriptorSize() == kPRSDSize);

/// The Gaussian Euclidean distance transform, see SymmetryDescriptors::gedt.
struct GEDTSignature32768 {
  float gedt[32768] = {};
  static constexpr int descriptorSize() { return 32768; }
};
static_assert(GEDTSignature32768::descriptorSize() == kGEDTSize);

/// What matching compares, see shapeSignature().
struct ShapeSignature20736 {
  float signature[20736] = {};
  static constexpr int descriptorSize() { return 20736; }
};
static_assert(ShapeSignature20736::descriptorSize() == kSignatureSize);

}  // namespace pcl_symmetry

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSTSignature32768, (float[32768], prst, prst))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSDSignature1024, (float[1024], prsd, prsd))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::GEDTSignature32768, (float[32768], gedt, gedt))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::ShapeSignature20736, (float[20736], signature, signature))
