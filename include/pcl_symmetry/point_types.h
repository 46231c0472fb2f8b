/// Descriptors as PCL point types (Section 5.2): PCD files hold them, and search trees compare all their values. As for
/// all point types that PCL does not know, search trees need pcl/kdtree/impl/kdtree_flann.hpp.
#pragma once

#include <pcl/point_representation.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The planar-reflective symmetry transform: sqrt(max(D, 0)) in 32 x 32 x 32 bins (theta, phi, r), r fastest.
struct PRSTSignature32768 {
  float prst[32768] = {};                                  ///< not negative
  static constexpr int descriptorSize() { return 32768; }  ///< number of values
};

/// The planar-reflective symmetry descriptor of Kazhdan et al. (2004): sqrt(max(D, 0)) of the planes through the center
/// in 32 x 32 bins (theta, phi), phi fastest.
struct PRSDSignature1024 {
  float prsd[1024] = {};                                  ///< not negative
  static constexpr int descriptorSize() { return 1024; }  ///< number of values
};

/// The Gaussian Euclidean distance transform f in 32 x 32 x 32 cells, x fastest.
struct GEDTSignature32768 {
  float gedt[32768] = {};                                  ///< in [0, 1]
  static constexpr int descriptorSize() { return 32768; }  ///< number of values
};

/// Where the surface of a shape lies and which way it faces, in a frame of its symmetry: two cubes of 6 x 12^3 values.
/// SymmetryDatabase compares its compact form.
struct ShapeSignature20736 {
  float signature[20736] = {};                             ///< of unit length together
  static constexpr int descriptorSize() { return 20736; }  ///< number of values
};

}  // namespace pcl_symmetry

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSTSignature32768, (float[32768], prst, prst))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSDSignature1024, (float[1024], prsd, prsd))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::GEDTSignature32768, (float[32768], gedt, gedt))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::ShapeSignature20736, (float[20736], signature, signature))

namespace pcl {

// Without these, search trees compare the first three values only.
template <>
class DefaultPointRepresentation<pcl_symmetry::PRSTSignature32768>
    : public DefaultFeatureRepresentation<pcl_symmetry::PRSTSignature32768> {};
template <>
class DefaultPointRepresentation<pcl_symmetry::PRSDSignature1024>
    : public DefaultFeatureRepresentation<pcl_symmetry::PRSDSignature1024> {};
template <>
class DefaultPointRepresentation<pcl_symmetry::GEDTSignature32768>
    : public DefaultFeatureRepresentation<pcl_symmetry::GEDTSignature32768> {};
template <>
class DefaultPointRepresentation<pcl_symmetry::ShapeSignature20736>
    : public DefaultFeatureRepresentation<pcl_symmetry::ShapeSignature20736> {};

}  // namespace pcl
