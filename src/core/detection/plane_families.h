#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// Whether a plane contains a line, normalized frame, within kDetection.families.
bool contains(const ReflectionPlane& plane, const Line3d& line);

/// Continuous families of planes: all planes through a line (a body of revolution) or through a point (a sphere).
///
/// A family is tested rather than inferred from many planes: planes at angles that occur in no regular polygon must be
/// as good as the planes found.
struct FamilyTest {
  /// Measures the share of the visible surface that a plane maps onto the surface, in [0, 1].
  std::function<double(const ReflectionPlane&)> share;
  /// The same from fewer samples, to reject most lines early.
  std::function<double(const ReflectionPlane&)> rough_share;
  /// Finds the best plane nearby.
  std::function<ReflectionPlane(const ReflectionPlane&)> refine;
  double min_share;  ///< least mean share of the planes of a family, in [0, 1]
  /// Allowed deficit of that mean to the share of the best plane: an effect of sampling, not of a handle.
  double allowance;
};

/// The line closest to all planes that share a line.
/// \param planes at least two that are not parallel.
Line3d commonLine(const std::vector<ReflectionPlane>& planes);

/// All planes through a line or a point, if they are symmetries.
template <typename Common>
struct PlaneFamily {
  Common common;                        ///< the line or the point
  double share;                         ///< mean share over the planes
  std::vector<ReflectionPlane> planes;  ///< planes that were tested
};
using AxisFamily = PlaneFamily<Line3d>;
using CenterFamily = PlaneFamily<Eigen::Vector3d>;

/// \param planes symmetries found, best first.
/// \param guesses further candidate points, besides the common point of the planes.
std::optional<CenterFamily> findCenter(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                       const std::vector<Eigen::Vector3d>& guesses = {});

/// \param planes symmetries found, best first.
/// \param guesses candidate lines, tried before the common lines of two planes.
/// \return families, best first.
std::vector<AxisFamily> findAxes(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                 const std::vector<Line3d>& guesses = {});

/// \param planes,axes input frame.
/// \return the planes that contain no axis.
std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes,
                                                const std::vector<SymmetryAxis>& axes, const NormalizedCloud& cloud);

/// \param planes,center input frame.
/// \return the planes that do not contain the center.
std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes, const SymmetryCenter& center,
                                                const NormalizedCloud& cloud);

}  // namespace pcl_symmetry
