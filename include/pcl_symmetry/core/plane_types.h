#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Role of a plane for the shape.
enum class PlaneKind {
  Symmetry,     ///< of the whole object: confidence >= min_confidence
  Possible,     ///< confidence >= min_possible: the data do not decide
  Approximate,  ///< less than that: a local maximum of the transform
  Local         ///< a symmetry of a part: of the points that support it
};

/// \return "symmetry", "possible", "approximate" or "local".
inline const char* toString(PlaneKind kind) {
  constexpr const char* names[] = {"symmetry", "possible", "approximate", "local"};
  return names[static_cast<int>(kind)];
}

/// Why a plane has its confidence and kind.
struct Reason {
  const char* rule = "";  ///< the observation, in a few words
  /// Factor on the odds of the confidence; for the first reason, the odds themselves. The product of all odds is
  /// confidence / (1 - confidence). None: limits the plane to a possible symmetry.
  std::optional<double> odds;
};

/// A refined local maximum of the transform. Canonical: theta of the normal in [0, pi/2].
struct SymmetryPlane : ReflectionPlane {
  SymmetryPlane() = default;
  explicit SymmetryPlane(const ReflectionPlane& plane) : ReflectionPlane(plane.canonical()) {}  ///< in canonical form

  PlaneKind kind = PlaneKind::Approximate;  ///< result of the decision
  /// Probability that this is a symmetry of the object, in [0, 1]; comparable between objects, densities, noise levels,
  /// whole and partial clouds; 0 as published. src/core/evidence/README.md has the formula, its calibration and limits.
  double confidence = 0.0;
  /// D(f, gamma) of equation 2 at this very plane: the correlation of the GEDT with its reflection, in [0, 1].
  double score = 0.0;
  /// Share of the surface seen that the plane maps onto the surface, relative to what sampling and noise allow, [0, 1].
  double support = 0.0;
  /// Estimated share of the informative part of the surface that the plane maps to within the tolerance of the surface,
  /// in [0, 1]. A plane is a symmetry of the object if that share is at least 0.97. NaN, with its limits, for volumes,
  /// which have no surface, and as published.
  double share = 0.0;
  /// Lower limit of that share for the whole object: it lies between the limits in 95 of 100 cases, in [0, 1].
  double share_low = 0.0;
  double share_high = 1.0;  ///< upper limit
  /// Distance from the surface within which 97 % of the reflected points stay, input units: the least tolerance at
  /// which the plane would be a symmetry; the diameter if it is beyond the search range. NaN where the share is.
  double deviation = 0.0;
  /// Share of the points whose reflection falls where the cloud could show it, in [0, 1]: less than 1 for planes of
  /// scans and where a piece of the surface is missing.
  double seen = 1.0;
  /// One value in [0, 1] per point used, in their order: 1 where the reflection is as close to the surface as samples
  /// of a surface are to each other, falling to 0 beyond; NaN where the scanner could not see whether it is. In large
  /// clouds, a point takes the value of one near it.
  std::vector<float> point_support;
  std::vector<Reason> reasons;  ///< of confidence and kind, in the order of the rules; none as published
  int iterations = 0;           ///< of Iterative Symmetric Points, in all stages
  bool converged = false;       ///< the plane stood still
  double residual = 0.0;  ///< weighted root mean square distance of the reflected points from the surface, input units
};

/// All planes through a line are symmetries: a body of revolution.
struct SymmetryAxis {
  Eigen::Vector3d point;      ///< of the axis, the closest to the center of the bounding ball; input frame
  Eigen::Vector3d direction;  ///< unit
  /// As in SymmetryPlane, for planes at eight angles together; as in SymmetryRotation for axes that only rotations of a
  /// scan show.
  double confidence = 0.0;
  double score = 0.0;    ///< mean D of these planes
  double support = 0.0;  ///< mean support of these planes
};

/// A line about which rotations map the visible surface onto itself or to unseen space, as the axis of a nut, a wheel
/// or a bottle seen from one side. Not in the paper.
struct SymmetryRotation {
  Eigen::Vector3d point;      ///< of the axis, the closest to the center of the bounding ball; input frame
  Eigen::Vector3d direction;  ///< unit
  int fold = 0;               ///< order of the rotations; 0: by any angle
  /// Probability that these rotations are symmetries of the whole object at the limits of ObjectSymmetryOptions.
  double confidence = 0.0;
  // Shares of the points seen, in [0, 1].
  double support = 0.0;  ///< that the best rotation maps onto the surface seen; a small rotation for any angle
  double off = 0.0;      ///< that the worst rotation maps into free space
  double far = 0.0;      ///< the same, beyond ten tolerances of the surface
  double halfway = 0.0;  ///< off of rotations halfway between those of the fold: evidence against other folds
};

/// All planes through a point are symmetries: a sphere. In a scan, rotations about lines through the point show it.
struct SymmetryCenter {
  Eigen::Vector3d point;    ///< input frame
  double confidence = 0.0;  ///< as in SymmetryAxis
  double score = 0.0;       ///< as in SymmetryAxis
  double support = 0.0;     ///< as in SymmetryAxis; in scans as in SymmetryRotation
};

/// Result of detectPlanes().
struct Detection {
  /// Why there is no answer, one sentence such as "12 distinct points, at least 20 are needed"; empty where the search
  /// ran, whatever it found.
  std::string reason;
  std::vector<SymmetryPlane> planes;  ///< symmetries, then possible, then approximate and local; each best first
  /// The plane that maps the greatest share of the surface, if there is no symmetry and no possible one; else empty.
  std::optional<SymmetryPlane> best;
  /// Whether there is no symmetry only because few points of a whole cloud leave it open: the share of the surface that
  /// the best plane maps may also be that of a symmetry.
  bool undecided = false;
  /// The plane within whose tolerance (three tolerances where noise hides the surface) 97 % of the points lie, as for a
  /// sheet, a disc or one side of a box. Reflections across it move no point and are uninformative.
  std::optional<ReflectionPlane> flat;
  double tolerance = 0.0;               ///< of the decision, input units
  double resolution = 0.0;              ///< least tolerance that sensor or spacing resolve, input units; 0 = unknown
  double diameter = 0.0;                ///< between two points, each the farthest from the other, input units
  int num_stray_points = 0;             ///< far from all others and left out; they support no plane
  std::vector<SymmetryAxis> axes;       ///< best first; their planes are not among planes
  std::vector<SymmetryCenter> centers;  ///< of spheres
  std::vector<SymmetryRotation> rotations;                ///< of scans: axes of rotations, most confident first
  SymmetryMap map;                                        ///< the map that was computed; empty where one was given
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order

  /// Whether planes belong to an axis or a center.
  bool hasFamily() const { return !axes.empty() || !centers.empty(); }
};

}  // namespace pcl_symmetry
