/// Descriptors as PCL point types (Section 5.2): PCD files hold them, and search trees compare all their values. As for
/// all point types that PCL does not know, search trees need pcl/kdtree/impl/kdtree_flann.hpp.
#pragma once

#include <pcl/point_representation.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

constexpr int kSquareOfBins = 32 * 32, kCubeOfBins = 32 * kSquareOfBins;
constexpr int kSignatureValues = 20736;  // 2 * 6 * 12^3

}  // namespace detail

/// The planar-reflective symmetry transform: sqrt(max(D, 0)) in 32 x 32 x 32 bins (theta, phi, r), r fastest.
struct PRSTSignature32768 {
  float prst[detail::kCubeOfBins] = {};                                  ///< not negative
  static constexpr int descriptorSize() { return detail::kCubeOfBins; }  ///< number of values
};

/// The planar-reflective symmetry descriptor of Kazhdan et al. (2004): sqrt(max(D, 0)) of the planes through the center
/// in 32 x 32 bins (theta, phi), phi fastest.
struct PRSDSignature1024 {
  float prsd[detail::kSquareOfBins] = {};                                  ///< not negative
  static constexpr int descriptorSize() { return detail::kSquareOfBins; }  ///< number of values
};

/// The Gaussian Euclidean distance transform f in 32 x 32 x 32 cells, x fastest.
struct GEDTSignature32768 {
  float gedt[detail::kCubeOfBins] = {};                                  ///< in [0, 1]
  static constexpr int descriptorSize() { return detail::kCubeOfBins; }  ///< number of values
};

/// Where the surface of a shape lies and which way it faces, in a frame of its symmetry: two cubes of 6 x 12^3 values.
/// SymmetryDatabase compares its compact form.
struct ShapeSignature20736 {
  float signature[detail::kSignatureValues] = {};                             ///< vector of unit length
  static constexpr int descriptorSize() { return detail::kSignatureValues; }  ///< number of values
};

}  // namespace pcl_symmetry

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSTSignature32768,
                                  (float[pcl_symmetry::detail::kCubeOfBins], prst, prst))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::PRSDSignature1024,
                                  (float[pcl_symmetry::detail::kSquareOfBins], prsd, prsd))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::GEDTSignature32768,
                                  (float[pcl_symmetry::detail::kCubeOfBins], gedt, gedt))
POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_symmetry::ShapeSignature20736,
                                  (float[pcl_symmetry::detail::kSignatureValues], signature, signature))

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
