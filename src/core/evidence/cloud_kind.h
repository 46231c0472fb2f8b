#pragma once

namespace pcl_symmetry {

/// What a cloud shows of an object. Evidence counts by other coefficients for each kind, and detection goes by other
/// rules (core/detection/kind_rules.h).
enum class CloudKind {
  Surface,  ///< the surface from all sides; a piece may be missing
  Scan,     ///< the surface seen from one viewpoint, or from a few
  Volume    ///< the points resolve no surface: they have neighbors on all sides, by noise beyond their spacing
};

}  // namespace pcl_symmetry
