#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Cells along each side of a cube of f. chosen: half blurs the shape, twice takes eight times the memory.
constexpr int kTurnableGEDTCells = 16;
/// Values of a turnable GEDT. derived: two shapes x cells, x fastest.
constexpr int kTurnableGEDTSize = 2 * kTurnableGEDTCells * kTurnableGEDTCells * kTurnableGEDTCells;

/// The Gaussian Euclidean distance transform as a descriptor (Section 5.2) that can be turned without computing it
/// again: what turnablePRST() is to PRST, for comparisons of the two alone.
///
/// Departure from the paper: f on 32^3 cells is averaged to 16^3, scaled to unit norm, and taken once in the
/// proportions of the shape and once of the shape stretched to equal root mean squares along the axes.
/// \param points 3 x N, finite, input units, at least two different ones.
/// \param axes unit vectors in columns, right-handed.
/// \return kTurnableGEDTSize values of unit norm.
/// \throws std::invalid_argument for points without extent.
std::vector<float> turnableGEDT(const PointsRef& points, const Eigen::Matrix3d& axes);

/// The turnable GEDT in the frame whose axes are axes * axisRotations()[rotation]^T.
/// \param gedt kTurnableGEDTSize values in the frame of the axes.
/// \param rotation index into axisRotations().
/// \param rotated kTurnableGEDTSize values, not overlapping \p gedt.
void rotateTurnableGEDT(const float* gedt, int rotation, float* rotated);

}  // namespace pcl_symmetry
