/// Surfaces to lay on one another, and how far a motion turns them.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry::test {

/// \return radians.
inline double angleOf(const Eigen::Isometry3d& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle();
}

inline PosedSurface surface(const Points& points, std::optional<Visibility> seen = {}) {
  return {points, std::move(seen), 1, 0};
}

}  // namespace pcl_symmetry::test
