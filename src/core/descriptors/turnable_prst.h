#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

constexpr int kTurnableNormals = 300;  ///< of planes
constexpr int kTurnableOffsets = 16;   ///< along each of them
/// Values of a turnable PRST: of two shapes, for each normal, the offsets.
constexpr int kTurnablePRSTSize = 2 * kTurnableNormals * kTurnableOffsets;

/// The transform as a descriptor (Section 5.2) in a form that can be turned: at normals which the rotations of the axes
/// map onto each other, so that it is compared in all orders and signs of the axes, as signatures are.
///
/// Departure from the paper: its bins in theta and phi have no such symmetry; normals lie on equiangular grids on the
/// faces of a cube, values are weighted by the root of the solid angle around them. PRST = sqrt(max(D, 0)), once in the
/// proportions of the shape and once stretched to equal root mean squares along the axes.
/// \param points 3 x N, finite, input units; at least two different ones. \param axes unit, in columns, right-handed.
/// \return kTurnablePRSTSize values of unit norm.
/// \throws std::invalid_argument for points without extent.
std::vector<float> turnablePRST(const PointsRef& points, const Eigen::Matrix3d& axes);

/// As rotateSignature(). \param prst kTurnablePRSTSize values. \param rotated as many, another place.
void rotateTurnablePRST(const float* prst, int rotation, float* rotated);

}  // namespace pcl_symmetry
