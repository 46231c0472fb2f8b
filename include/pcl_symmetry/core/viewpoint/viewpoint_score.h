#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A plane of symmetry as views see it.
struct ViewPlane {
  Eigen::Vector3d normal;  ///< unit
  double weight;           ///< M, how much of a symmetry it is, >= 0
};

struct RankedView {
  Eigen::Vector3d direction;  ///< unit, from the object to the camera
  double score;               ///< S
};

/// S(v) = sum M |v . n| (Section 5.4): large where v looks across the planes, so that little of what is seen is
/// repeated. \param direction unit.
double viewpointScore(const std::vector<ViewPlane>& planes, const Eigen::Vector3d& direction);

/// The local maxima of S, best first, each with its opposite.
///
/// Where no v . n changes sign, S(v) = v . sum +-M n: it is greatest at the direction of that sum. From each of the
/// even directions the step to the sum is repeated until the signs stay; no step goes down, so that the maxima are
/// exact. \param planes at least one with weight > 0; else all directions are equal, and none is returned.
std::vector<RankedView> bestViews(const std::vector<ViewPlane>& planes, int num_directions = 4096);

/// The direction of least S. On a piece of the sphere where no v . n changes sign, S is least at a corner: the search
/// is over the directions along two planes at a time, and exact. Of one plane, or parallel ones, all directions along
/// it are equal, and one of them is returned. \param planes at least one.
RankedView worstView(const std::vector<ViewPlane>& planes);

}  // namespace pcl_symmetry
