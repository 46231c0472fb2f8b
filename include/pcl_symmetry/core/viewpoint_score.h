#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A plane of symmetry as the viewpoint score sees it: u and M(u) of Section 5.4.
struct ViewPlane {
  Eigen::Vector3d normal;  ///< u, unit
  double weight;           ///< M(u), the symmetry score of the plane, >= 0
};

/// W of Section 5.4: planes, and maxima in directions without planes, strongest first.
/// \param axes directions and scores of axes of revolution. Each counts as a fan of planes with the weight of two
/// planes.
/// \param maxima normals and values of maxima of the map, strongest first. As long as some direction scores less than a
/// fifth of the best one, the strongest maximum whose normal is more than 60 degrees from all planes so far is added:
/// without the weak maximum perpendicular to its axis, a mug would be best seen level from the side.
std::vector<ViewPlane> viewPlanes(std::vector<ViewPlane> planes, const std::vector<ViewPlane>& axes,
                                  const std::vector<ViewPlane>& maxima);

/// A view direction and its score.
struct RankedView {
  Eigen::Vector3d direction;  ///< v, unit, from the object to the camera
  double score;               ///< S(v), >= 0
};

/// The viewpoint score S(v) = sum over u in W of |v . u| M(u) (Section 5.4). It is large if v looks along the normals
/// of the planes, so that little of the visible surface is repeated.
/// \param planes W.
/// \param direction v, unit.
/// \return S(v) in [0, sum of the weights].
double viewpointScore(const std::vector<ViewPlane>& planes, const Eigen::Vector3d& direction);

/// The local maxima of S, best first, each with its opposite.
///
/// Departure from the paper: it searches exhaustively; here, where no v . u changes its sign, S(v) = v . sum of +-M(u)
/// u is largest in the direction of that sum. From each of many evenly spread directions this step is repeated; it
/// never lowers S.
/// \param planes W.
/// \return empty if no plane has a weight > 0: then all directions are equal.
std::vector<RankedView> bestViews(const std::vector<ViewPlane>& planes);

/// The direction with the least S.
///
/// Where no v . u changes its sign, S is least at a corner of the cell, a direction along two planes: all pairs of
/// planes are tried. If all planes are parallel, one of the directions along them is returned.
/// \param planes W, at least one.
/// \throws std::invalid_argument if there is no plane.
RankedView worstView(const std::vector<ViewPlane>& planes);

}  // namespace pcl_symmetry
