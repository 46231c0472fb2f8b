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

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct PlaneLattice {
  Line3d line;
  int fold = 0;        ///< number of planes, >= 3
  double phase = 0.0;  ///< angle of the normal of plane 0 from line.direction().unitOrthogonal(), radians

  /// \param k of any sign, may be a fraction: k + 0.5 lies halfway between two planes.
  ReflectionPlane plane(double k) const;
};

/// Finds the regular polygon of a noisy cloud about a line: the density of points in rings about the line, as a
/// function of the angle, has one strong frequency. It sums over all points and finds folds that no single plane shows.
/// \param all the points of the cloud and those removed to make it evenly dense, normalized frame.
/// \param line normalized frame.
/// \return nothing if no frequency stands out: no rotation maps the cloud onto itself, or all rotations do.
std::optional<PlaneLattice> latticeBySpectrum(const Points& all, const Line3d& line);

}  // namespace pcl_symmetry
