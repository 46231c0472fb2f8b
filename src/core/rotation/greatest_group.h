#pragma once

#include <vector>

#include "core/rotation/turning_axes.h"

namespace pcl_symmetry {

/// The greatest group that axes are part of and that the surface supports as a whole.
/// \param axes from turningAxes().
/// \return C_1 where there is no axis.
PlacedGroup greatestGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                          const std::vector<TurningAxis>& axes);

}  // namespace pcl_symmetry
