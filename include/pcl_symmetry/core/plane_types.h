#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Role of a plane for the shape.
enum class PlaneKind {
  Symmetry,     ///< a symmetry of the whole object: confidence >= min_confidence
  Possible,     ///< the data do not decide: confidence >= min_possible
  Approximate,  ///< a local maximum of the transform of less confidence
  Local         ///< a symmetry of a part, whose points support it
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
  /// Makes the plane canonical.
  explicit SymmetryPlane(const ReflectionPlane& plane) : ReflectionPlane(plane.canonical()) {}

  PlaneKind kind = PlaneKind::Approximate;  ///< result of the decision
  /// Probability that this is a symmetry of the object, in [0, 1]; comparable between objects, densities, noise levels,
  /// whole and partial clouds; 0 for published planes. src/pages/algorithms/decision.md has the formula, its
  /// calibration and its limits.
  double confidence = 0.0;
  /// D(f, gamma) of equation 2 at this very plane: the correlation of the GEDT with its reflection, in [0, 1].
  double score = 0.0;
  /// Share of the visible surface that the plane maps onto the surface, relative to what sampling and noise allow, in
  /// [0, 1].
  double support = 0.0;
  /// Estimated share of the informative part of the surface that the plane maps to within the tolerance of the surface,
  /// in [0, 1]. A plane is a symmetry of the object if that share is at least 0.97. The share and its limits are NaN
  /// for volumes, which have no surface, and for published planes.
  double share = 0.0;
  /// Lower limit of that share for the whole object, in [0, 1]: it lies between the limits in 95 of 100 cases.
  double share_low = 0.0;
  double share_high = 1.0;  ///< upper limit of that share, in [0, 1]
  /// Distance from the surface within which 97 % of the reflected points stay, input units: the least tolerance at
  /// which the plane would be a symmetry; the diameter if it is beyond the search range. NaN where `share` is.
  double deviation = 0.0;
  /// Share of the points whose reflection falls where the cloud could show a surface, in [0, 1]: less than 1 for planes
  /// of scans, and where a piece of the surface is missing.
  double seen = 1.0;
  /// One value in [0, 1] per point used, in their order: 1 where the reflection is as close to the surface as samples
  /// of a surface are to each other, falling to 0 beyond; NaN where the scanner could not see whether it is. In large
  /// clouds, a point takes the value of one near it.
  std::vector<float> point_support;
  /// Reasons for confidence and kind, in the order of the rules; empty for published planes.
  std::vector<Reason> reasons;
  int iterations = 0;      ///< steps of refinement, in all stages
  bool converged = false;  ///< whether the last stage converged
  double residual = 0.0;   ///< weighted root mean square distance of the reflected points from the surface, input units
};

/// An axis of revolution: all planes through it are symmetries.
struct SymmetryAxis {
  Eigen::Vector3d point;      ///< point of the axis closest to the center of the bounding ball, input frame
  Eigen::Vector3d direction;  ///< unit vector along the axis, input frame
  /// Confidence as in SymmetryPlane, of planes at eight angles together; as in SymmetryRotation if only rotations of a
  /// scan show the axis.
  double confidence = 0.0;
  double score = 0.0;    ///< mean D of planes through the axis
  double support = 0.0;  ///< mean support of planes through the axis
};

/// A line about which rotations map the visible surface onto itself or into unseen space, such as the axis of a nut, a
/// wheel or a bottle seen from one side. Not in the paper.
struct SymmetryRotation {
  Eigen::Vector3d point;      ///< point of the axis closest to the center of the bounding ball, input frame
  Eigen::Vector3d direction;  ///< unit vector along the axis, input frame
  int fold = 0;               ///< order of the rotations; 0 = by any angle
  /// Probability that these rotations map all but 10 % of the whole surface to within 1 % of the diameter of the
  /// surface, and all but 1.25 % to within ten times that.
  double confidence = 0.0;
  /// Share of the visible points that the best rotation maps onto the visible surface, in [0, 1]; for rotations by any
  /// angle, the mean of two small ones.
  double support = 0.0;
  double off = 0.0;  ///< share of the visible points that the worst rotation maps into free space, in [0, 1]
  /// Share of the visible points that the worst rotation maps into free space, farther than ten tolerances from the
  /// surface, in [0, 1].
  double far = 0.0;
  /// `off` of the rotations by angles halfway between those of the fold, in [0, 1]: evidence against other folds.
  double halfway = 0.0;
};

/// A center of spherical symmetry: all planes through it are symmetries. In a scan, rotations about lines through it
/// show it.
struct SymmetryCenter {
  Eigen::Vector3d point;    ///< input frame
  double confidence = 0.0;  ///< as in SymmetryAxis
  double score = 0.0;       ///< as in SymmetryAxis
  double support = 0.0;     ///< as in SymmetryAxis; in scans as in SymmetryRotation
};

/// Options of detectPlanes(); the defaults suit any shape and unit.
struct DetectionOptions {
  /// Greatest deviation of a symmetric surface, as a share of the greatest distance between two points, in (0, 0.1]: a
  /// symmetry maps 97 % of the surface to within this distance of the surface.
  double tolerance = 0.01;
  /// Upper limit of the tolerance, as a share of the same distance, in (0, 0.1]: if a depth camera or few points do not
  /// resolve `tolerance`, the tolerance that they resolve is used, up to this limit. If the limit is at most
  /// `tolerance`, `tolerance` is always used, and symmetries that the camera does not resolve are reported as possible.
  double max_tolerance = 0.03;
  double absolute_tolerance = 0.0;  ///< replaces both tolerances, input units, >= 0; 0 = not used
  double min_confidence = 0.5;      ///< a plane is a symmetry if confidence >= min_confidence; in [0, 1]
  double min_possible = 0.2;  ///< a plane is reported as possible if confidence >= min_possible; in [0, min_confidence]
  /// Also reports the other maxima, after the symmetries: approximate symmetries of the whole, and symmetries of parts.
  bool approximate = false;
  bool rotations = true;  ///< also searches axes of rotation of scans; false saves about a third of the time
  bool folds = true;     ///< with `rotations`: also axes of finite order; false finds bodies of revolution only, faster
  int max_planes = 128;  ///< greatest number of planes, >= 1; a gear of 120 teeth has 121
  int num_cells = 64;    ///< cells of the distance transform along each side, in [8, 512]
  /// Width of the Gaussian, input units, >= 0; 0 = two cells, or the spacing of the points if that is more.
  double sigma = 0.0;
  std::uint64_t seed = 1;  ///< seed of all random draws; the same seed gives the same answer
  int num_threads = 0;     ///< >= 0; 0 = one per core; the answer does not depend on it

  /// Expert options, and the bins of the map that candidates come from.
  struct Expert : MapSize {
    int num_samples = 64;       ///< samples of the transform, >= 1: an error of 1 % of PRST, enough to find maxima
    LocalMaximaOptions maxima;  ///< thresholds of the maxima of the map that become candidates
    int max_candidates = 24;    ///< strongest maxima that are refined, >= 1
    /// Points reflected in the last stage (the paper's figure), >= 10; in scans a quarter of them, which also judge the
    /// planes.
    int num_refine_samples = 10'000;
  };
  Expert expert;  ///< options for experts

  /// \return num_cells, sigma and num_threads as options of the distance transform.
  GaussianEdtOptions edtOptions() const { return {num_cells, sigma, num_threads}; }

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Result of detectPlanes().
struct Detection {
  /// Why there is no answer, one sentence such as "12 distinct points, at least 20 are needed"; empty where the search
  /// ran, whatever it found.
  std::string reason;
  std::vector<SymmetryPlane> planes;  ///< symmetries, then possible, then approximate and local; each best first
  /// The plane that maps the greatest share of the surface, if there is no symmetry and no possible one; else empty.
  std::optional<SymmetryPlane> best;
  /// Whether the cloud is whole and has too few points to decide: no plane is a symmetry, but the best one may map
  /// enough of the surface to be one.
  bool undecided = false;
  /// A plane near which 97 % of the points lie, within the tolerance (three tolerances where noise hides the surface),
  /// as for a sheet, a disc or one side of a box. A reflection in it moves no point and is uninformative.
  std::optional<ReflectionPlane> flat;
  double tolerance = 0.0;               ///< tolerance of the decision, input units
  double resolution = 0.0;              ///< least tolerance that sensor or spacing resolve, input units; 0 = unknown
  double diameter = 0.0;                ///< distance between two points, each the farthest from the other, input units
  int num_stray_points = 0;             ///< points far from all others, which were left out and support no plane
  std::vector<SymmetryAxis> axes;       ///< best first; their planes are not among planes
  std::vector<SymmetryCenter> centers;  ///< centers of spheres, best first
  std::vector<SymmetryRotation> rotations;                ///< axes of rotation of scans, most confident first
  SymmetryMap map;                                        ///< map that was computed; empty if one was given
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds

  /// Whether planes belong to an axis or a center.
  bool hasFamily() const { return !axes.empty() || !centers.empty(); }
};

}  // namespace pcl_symmetry
