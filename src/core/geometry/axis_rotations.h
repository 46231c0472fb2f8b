#pragma once

#include <Eigen/Core>
#include <array>

namespace pcl_symmetry {

/// The rotations that map the coordinate axes onto each other: how a frame can be laid on another one where neither
/// order nor signs of its axes are known.
constexpr int kNumAxisRotations = 24;

/// Signed permutation matrices of determinant 1, the identity first.
const std::array<Eigen::Matrix3i, kNumAxisRotations>& axisRotations();

}  // namespace pcl_symmetry
