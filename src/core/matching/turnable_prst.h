#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

constexpr int kTurnableNormals = 300;  ///< directions of planes. derived: 3 pairs of cube faces x 10 x 10 normals
/// Offsets of planes along each normal. chosen: half blurs parallel planes, twice doubles size and time.
constexpr int kTurnableOffsets = 16;
/// Values of a turnable PRST. derived: two shapes x normals x offsets, offsets fastest.
constexpr int kTurnablePRSTSize = 2 * kTurnableNormals * kTurnableOffsets;

/// The transform as a descriptor (Section 5.2) that can be turned without computing it again: the rotations of the axes
/// map its normals onto each other. So it is compared in all orders and signs of the axes, as signatures are.
///
/// Departures from the paper: the normals lie on equiangular grids on the faces of a cube, as bins in theta and phi
/// have no such symmetry; values are weighted by the root of the solid angle around their normal, where the paper
/// weights differences by sqrt(sin theta). Values are sqrt(D), see SymmetryDescriptors::prst, once in the proportions
/// of the shape and once for the shape stretched to equal root mean squares along the axes.
/// \param points 3 x N,
/// finite, input units, at least two different ones.
/// \param axes unit vectors in columns, right-handed.
/// \return
/// kTurnablePRSTSize values of unit norm.
/// \throws std::invalid_argument for points without extent.
std::vector<float> turnablePRST(const PointsRef& points, const Eigen::Matrix3d& axes);

/// The turnable PRST in the frame whose axes are axes * axisRotations()[rotation]^T.
/// \param prst kTurnablePRSTSize values in the frame of the axes.
/// \param rotation index into axisRotations().
/// \param rotated kTurnablePRSTSize values, not overlapping \p prst.
void rotateTurnablePRST(const float* prst, int rotation, float* rotated);

}  // namespace pcl_symmetry
