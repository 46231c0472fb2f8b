#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

/// The poses that bring the symmetry frame of one cloud to that of another, in all ways that symmetry leaves open
/// (Section 5.1).
///
/// The axes of \p b may have any order and any signs that are a rotation: 24 ways, from every equally good frame of
/// \p a that is a maximum. About an axis of revolution of \p a the poses turn in steps of 45 degrees: between a scan
/// and a whole, the handle of a mug may be hidden.
/// \param a,b frames of two clouds, each in its own input frame.
/// \return T_b_a; poses whose rotation is within 10 degrees of an earlier one are left out.
std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b);

}  // namespace pcl_symmetry
