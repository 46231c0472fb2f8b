#pragma once

#include <vector>

#include "core/rotation/rotation_fit.h"

namespace pcl_symmetry {

/// A line that a shape may turn about.
struct AxisLineCandidate {
  Eigen::Vector3d direction;  ///< unit
  Eigen::Vector3d center;     ///< on the line
};

/// Lines through \p center, in all directions, about which a turn of prime order overlaps most with the surface; a
/// symmetry of any order has one of prime order. \param num_directions on a half sphere.
std::vector<AxisLineCandidate> searchAxes(const RotationFit& fit, const Eigen::Vector3d& center, int num_directions,
                                          int max_fold, int num_threads);

/// The n of 2 to \p max_fold whose turn by 2 pi / n overlaps best with the surface.
int likeliestFold(const RotationFit& fit, const AxisLineCandidate& line, int max_fold);

/// Those whose turns overlap nearly as well, the least first.
std::vector<int> likelyFolds(const RotationFit& fit, const AxisLineCandidate& line, int max_fold);

/// Of the turns by pi about axes across a line, at \p num_angles in [0, width), the one that overlaps most.
/// \param offsets of the axis along the line, from its center.
AxisLineCandidate bestAcross(const RotationFit& fit, const AxisLineCandidate& line, double width, int num_angles,
                             const std::vector<double>& offsets);

}  // namespace pcl_symmetry
