#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/frame/symmetry_frame.h"

namespace pcl_symmetry {

/// The poses T_b_a that bring the symmetry frame of one cloud to that of another, in all ways that symmetry leaves
/// open: the axes in any order and with any signs that are a rotation (24), from every frame of \p a that is a maximum
/// and equally good; and where an axis of \p a is one of revolution, in steps of 45 degrees about it (between a scan
/// and a whole the handle of a mug may not be seen). Poses closer than 10 degrees to one before them are left out.
std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b);

}  // namespace pcl_symmetry
