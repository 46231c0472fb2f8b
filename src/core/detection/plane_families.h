#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry {

/// Continuous families of planes: all planes through a line (a body of revolution) or through a point (a sphere).
///
/// A family is tested, not guessed from many planes: planes at angles that are in step with no polygon have to be as
/// good as the planes that were found.
struct FamilyTest {
  /// Share of what is seen of the surface that a plane maps onto the surface, in [0, 1].
  std::function<double(const ReflectionPlane&)> share;
  /// The same from fewer points, to find out early that a line is none.
  std::function<double(const ReflectionPlane&)> rough_share;
  /// The plane after refinement.
  std::function<ReflectionPlane(const ReflectionPlane&)> refine;
  double min_share;  ///< of a symmetry
  double
      allowance;  ///< by which a family may be worse than the planes that were found: what sampling does, not a handle
  double tolerance;  ///< offset within which planes pass through a point, units of the planes' frame
};

using AxisLine = Eigen::ParametrizedLine<double, 3>;

/// A line of planes and their mean share.
struct AxisFamily {
  AxisLine line;
  double share;
  std::vector<ReflectionPlane> planes;  ///< that were tested
};

/// A point of planes and their mean share.
struct CenterFamily {
  Eigen::Vector3d point;
  double share;
  std::vector<ReflectionPlane> planes;  ///< that were tested
};

/// \param planes symmetries found, best first. \return the point that all planes through are symmetries of, if any.
std::optional<CenterFamily> findCenter(const std::vector<ReflectionPlane>& planes, const FamilyTest& test);

/// \return lines that all planes through are symmetries of, best first.
std::vector<AxisFamily> findAxes(const std::vector<ReflectionPlane>& planes, const FamilyTest& test);

/// Whether a plane contains a line within 3 degrees and the tolerance.
bool contains(const ReflectionPlane& plane, const AxisLine& line, double tolerance);

}  // namespace pcl_symmetry
