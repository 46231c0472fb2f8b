#pragma once

#include <Eigen/Core>
#include <array>

namespace pcl_symmetry {

/// Number of rotations that map the coordinate axes onto each other.
/// 6 orders of the axes times 8 choices of sign, half of which are reflections.
constexpr int kNumAxisRotations = 24;

/// All rotations that map the coordinate axes onto each other. A frame whose axes have no known order and sign can be
/// laid on another frame in these ways.
/// \return signed permutation matrices of determinant 1, the identity first.
const std::array<Eigen::Matrix3i, kNumAxisRotations>& axisRotations();

}  // namespace pcl_symmetry
