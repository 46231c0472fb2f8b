#pragma once

#include <vector>

#include "core/rotation/rotation_fit.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

// Lines are in the normalised frame.

/// Centers that axes may pass through: the center of mass and, where it lies elsewhere because points are unevenly
/// dense, that of the bounding ball, which is 0.
std::vector<Eigen::Vector3d> axisCenters(const RotationFit& fit);

/// The principal axes of the points through these centers, and the line through both. A shape of revolution and one
/// with a fold of 3 or more about a single axis have it there.
std::vector<Line3d> principalLines(const RotationFit& fit);

/// Lines through these centers, in all directions, about which a turn of prime order overlaps most with the surface.
/// \param num_directions of lines through each center, on a half sphere.
/// \param max_fold greatest order of a rotation.
/// \param num_threads >= 0; 0 = one per core.
std::vector<Line3d> axisLineCandidates(const RotationFit& fit, int num_directions, int max_fold, int num_threads);

/// \return whether a line is one of \p lines: closer than 0.05 radians and radii.
bool isKnown(const std::vector<Line3d>& lines, const Line3d& line);

/// Angle between two lines, in [0, pi/2].
double angleBetweenLines(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Folds in [2, \p max_fold] whose turns by 2 pi / n overlap best with the surface, of those that overlap as well as
/// half the turn: one of at most 6, and one of all where that is another.
/// \return one or two, rising.
std::vector<int> likelyFolds(const RotationFit& fit, const Line3d& line, int max_fold);

/// The half turn, among those about axes perpendicular to a line, that overlaps most with the surface.
/// \param width the axes have \p num_angles angles in [0, width), radians.
/// \param offsets places of the axis along the line, from its center.
Line3d bestAcross(const RotationFit& fit, const Line3d& line, double width, int num_angles,
                  const std::vector<double>& offsets);

}  // namespace pcl_symmetry
