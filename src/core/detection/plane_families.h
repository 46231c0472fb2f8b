#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

struct JudgedCloud;
struct Found;

/// Whether a plane contains a line, within 3 degrees and \p tolerance.
bool contains(const ReflectionPlane& plane, const Line3d& line,
              double tolerance = kDetection.families.contained_offset);

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct PlaneLattice {
  Line3d line;
  int fold = 0;        ///< number of planes, >= 3
  double phase = 0.0;  ///< angle of the normal of plane 0 from line.direction().unitOrthogonal(), radians

  /// \param k of any sign, may be a fraction: k + 0.5 lies halfway between two planes.
  ReflectionPlane plane(double k) const;
};

/// The regular polygon about a line that a noisy cloud has: the density of points in rings about the line, by their
/// angle, has one strong frequency. It is the sum over all points, and finds folds that no single plane shows.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalized frame.
/// \param line normalized frame.
/// \return none where no frequency stands out: no rotation maps the cloud onto itself, or all do.
std::optional<PlaneLattice> latticeBySpectrum(const Points& all, const Line3d& line);

/// Completes polygons. The planes of noisy clouds are judged together, as they are symmetries together or not at all.
/// Those of surfaces are judged well enough alone, but many teeth leave them too close to be found one by one.
void completePolygon(const JudgedCloud& judged, Found& found);

/// Continuous families of planes: all planes through a line (a body of revolution) or through a point (a sphere).
///
/// A family is tested, not guessed from many planes: planes at angles that no regular polygon has must be as good as
/// the planes that were found.
struct FamilyTest {
  /// Share of the surface seen that a plane maps onto the surface, in [0, 1].
  std::function<double(const ReflectionPlane&)> share;
  /// The same from fewer samples, to drop most lines early.
  std::function<double(const ReflectionPlane&)> rough_share;
  /// The best plane nearby.
  std::function<ReflectionPlane(const ReflectionPlane&)> refine;
  double min_share;  ///< of the planes of a family, on average, in [0, 1]
  double allowance;  ///< by how much that may be less than the best plane found: an effect of sampling, not of a handle
};

/// The line closest to all planes that have one in common.
/// \param planes at least two that are not parallel.
Line3d commonLine(const std::vector<ReflectionPlane>& planes);

/// All planes through a line or a point, as symmetries.
template <typename Common>
struct PlaneFamily {
  Common common;                        ///< the line or the point
  double share;                         ///< mean over the planes
  std::vector<ReflectionPlane> planes;  ///< that were tested
};
using AxisFamily = PlaneFamily<Line3d>;
using CenterFamily = PlaneFamily<Eigen::Vector3d>;

/// \param planes symmetries found, best first.
/// \param guesses points that may be one, beside the common point of the planes.
std::optional<CenterFamily> findCenter(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                       const std::vector<Eigen::Vector3d>& guesses = {});

/// \param planes symmetries found, best first.
/// \param guesses lines that may be one, tried before those that two planes share.
/// \return best first.
std::vector<AxisFamily> findAxes(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                 const std::vector<Line3d>& guesses = {});

/// Finds the families that symmetries belong to: bodies of revolution and spheres in place of their planes. A cloud
/// that is a line gets that line as its axis.
void findFamilies(const JudgedCloud& judged, Found& found);

/// \param planes,axes input frame.
/// \return the planes that contain no axis.
std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes,
                                                const std::vector<SymmetryAxis>& axes, const NormalizedCloud& cloud);

/// \param planes,center input frame.
/// \return the planes that do not contain the center.
std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes, const SymmetryCenter& center,
                                                const NormalizedCloud& cloud);

}  // namespace pcl_symmetry
