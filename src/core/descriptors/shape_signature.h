#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Cells along each side of the cube that a signature looks at.
constexpr int kSignatureCells = 12;
/// Products of two components of a unit normal: xx, yy, zz, yz, zx, xy.
constexpr int kNumOrientations = 6;
/// Values of one signature: of two cubes, for each product, one per cell, x fastest.
constexpr int kSignatureSize = 2 * kNumOrientations * kSignatureCells * kSignatureCells * kSignatureCells;

/// What matching compares (Section 5.2): where the surface of a shape lies and which way it faces, in a frame of its
/// symmetry.
///
/// Departure from the paper: where its distance transform tells only how near the surface is, each cell holds the mean
/// over its surface of n n^T with n the normal, so that a wall differs from a floor at the same place; square roots of
/// the values, signs kept, are compared. The first cube has the proportions of the shape, in the second the shape is
/// stretched to equal root mean squares along the axes: it is the same for long and short things of a kind. The order
/// and the signs of the axes are left to the comparison, see rotateSignature().
/// \param points 3 x N, finite, input units; at least two different ones. \param axes unit, in columns, right-handed.
/// \return kSignatureSize values of unit norm.
/// \throws std::invalid_argument for points without extent.
std::vector<float> shapeSignature(const PointsRef& points, const Eigen::Matrix3d& axes);

/// Frames for signatures: the first axis of the symmetry frame with the directions of greatest and least spread across
/// it, which shapes of a kind share more often than weak planes, and the symmetry frame itself.
std::vector<Eigen::Matrix3d> signatureFrames(const PointsRef& points, const SymmetryFrame& frame);

/// Options of symmetryFrame() that are enough for signatures and take a third of the time.
FrameOptions signatureFrameOptions();

/// The signature in the frame whose axes are axes * axisRotations()[rotation]^T, from that in the frame of the axes.
/// \param signature kSignatureSize values. \param rotated as many, another place.
void rotateSignature(const float* signature, int rotation, float* rotated);

}  // namespace pcl_symmetry
