/// How far one frame of axes is turned against another, as far as symmetry can tell.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry::apps {

/// Degrees of the rotation between two right-handed frames (axes in columns), the smallest over any order and sign of
/// the axes of \p b and, where \p revolution is a column of \p b, over any angle about it; 3: 0.
double angleOfAxes(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, int revolution = -1);

/// Degrees of the rotation between a frame and the nearest of several, as they stand, or turned by any angle about
/// their column \p revolution; 3: 0.
double angleToNearest(const Eigen::Matrix3d& frame, const std::vector<Eigen::Matrix3d>& frames, int revolution = -1);

}  // namespace pcl_symmetry::apps
