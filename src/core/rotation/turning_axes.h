#pragma once

#include <vector>

#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

/// An axis with the turns about it that are symmetries.
struct TurningAxis {
  AxisLineCandidate line;
  int fold;  ///< 0: every turn
  PlacedGroup group;
};

/// The lines about which turns are symmetries, each once.
///
/// Axes of finite order are dropped once an axis of revolution is found. The search ends with two axes of revolution.
/// \param lines candidates, the likeliest first.
/// \return axes of revolution alone, or axes of finite order, the greatest order first.
std::vector<TurningAxis> turningAxes(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                     const std::vector<AxisLineCandidate>& lines);

}  // namespace pcl_symmetry
