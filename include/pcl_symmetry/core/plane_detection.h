#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/local_maxima.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// What a plane is to the shape.
enum class PlaneKind {
  Symmetry,     ///< of the whole object: confidence >= min_confidence
  Possible,     ///< confidence >= min_possible: the data do not decide
  Approximate,  ///< less than that: a local maximum of the transform
  Local         ///< a symmetry of a part: of the points that support it
};

/// A refined local maximum of the transform. Canonical: theta of the normal in [0, pi/2].
struct SymmetryPlane : ReflectionPlane {
  SymmetryPlane() = default;
  explicit SymmetryPlane(const ReflectionPlane& plane) : ReflectionPlane(plane.canonical()) {}  ///< in canonical form

  PlaneKind kind = PlaneKind::Approximate;  ///< what the decision is
  /// Probability that this is a symmetry of the object, in [0, 1]; comparable between objects, densities, noise levels,
  /// whole and partial clouds. src/core/evidence/README.md has the formula, its calibration and its limits.
  double confidence = 0.0;
  /// D(f, gamma) of equation 2 at this very plane: the correlation of the GEDT with its reflection, in [0, 1].
  double score = 0.0;
  /// Share of the surface seen that the plane maps onto the surface, relative to what sampling and noise allow, [0, 1].
  double support = 0.0;
  /// Estimate of the share of the surface that the plane maps to within the tolerance of the surface, in [0, 1]: of the
  /// part of the surface that says something. A plane is a symmetry of the object if that share is at least 0.97.
  double share = 0.0;
  /// Lower limit of that share for the whole object: it lies between the limits in 95 of 100 cases, in [0, 1].
  double share_low = 0.0;
  double share_high = 1.0;  ///< upper limit
  /// Distance that 97 % of the reflected points stay within from the surface, input units: the least tolerance at which
  /// the plane would be a symmetry.
  double deviation = 0.0;
  /// Share of the points whose reflection falls where the cloud could show it, in [0, 1]: less than 1 for planes of
  /// scans and where a piece of the surface is missing.
  double seen = 1.0;
  /// One value in [0, 1] per point used, in their order: 1 where the reflection is as close to the surface as samples
  /// of a surface are to each other, falling to 0 beyond. Of large clouds, points take that of one near them.
  std::vector<float> point_support;
  int iterations = 0;      ///< of Iterative Symmetric Points, in all stages
  bool converged = false;  ///< the plane stood still
  double residual = 0.0;   ///< weighted root mean square distance of the reflected points from the surface, input units
};

/// All planes through a line are symmetries: a body of revolution.
struct SymmetryAxis {
  Eigen::Vector3d point;      ///< of the axis, the closest to the center of the bounding ball; input frame
  Eigen::Vector3d direction;  ///< unit
  /// As that of SymmetryPlane, for planes at eight angles together; of axes of scans that only turns show that of
  /// SymmetryTurn.
  double confidence = 0.0;
  double score = 0.0;    ///< mean D of these planes
  double support = 0.0;  ///< mean support of these planes
};

/// Turns about a line map what a scanner saw onto itself or to unseen places: the axis of a nut, a wheel, a bottle seen
/// from one side. Beyond the paper (Section 6).
struct SymmetryTurn {
  Eigen::Vector3d point;      ///< of the axis, the closest to the center of the bounding ball; input frame
  Eigen::Vector3d direction;  ///< unit
  int fold = 0;               ///< order of the turns; 0: by any angle
  /// Probability that these turns are symmetries of the whole object at the limits of ObjectSymmetryOptions.
  double confidence = 0.0;
  // Shares of the points seen, in [0, 1].
  double support = 0.0;  ///< that the best turn maps onto the surface seen; a small turn for any angle
  double off = 0.0;      ///< that the worst turn maps to where the scanner saw that there is nothing
  double far = 0.0;      ///< the same, beyond ten tolerances of the surface
  double halfway = 0.0;  ///< off of turns halfway between those of the fold: these speak against other folds
};

/// What the decisions of one detection were taken from (core/detection/plane_judge.h); the Python module gives
/// it as arrays.
struct DetectionEvidence;

/// All planes through a point are symmetries: a sphere.
struct SymmetryCenter {
  Eigen::Vector3d point;    ///< input frame
  double confidence = 0.0;  ///< as that of SymmetryAxis
  double score = 0.0;       ///< as that of SymmetryAxis
  double support = 0.0;     ///< as that of SymmetryAxis
};

/// Options of detectPlanes(); the defaults suit any shape and unit.
struct DetectionOptions {
  GaussianEdtOptions edt;  ///< of the transform of distances
  /// Bins of the map that candidates come from. chosen: as many as the paper's 64 x 64 directions, but as fine in phi
  /// at the equator as in theta, because a peak of D is narrower than a bin of 5.6 degrees.
  int num_theta = 32;    ///< >= 1
  int num_phi = 128;     ///< even, >= 2
  int num_radius = 64;   ///< >= 1
  int num_samples = 64;  ///< samples of the transform, >= 1. measured: the error is 1 % of PRST, enough to find maxima
  LocalMaximaOptions maxima;     ///< of the maxima of the map that become candidates
  int max_candidates = 24;       ///< strongest maxima that are refined, >= 1
  bool principal_planes = true;  ///< planes across the principal axes are candidates too
  /// A candidate that refinement moves by more than this many bins beyond its own is unstable and dropped, >= 0.
  /// Departure from the paper, which has 0: one bin leaves room for the noise of the sampled map.
  double max_drift = 1.0;
  IspUpdate update = IspUpdate::PointToPlane;  ///< what a step of the refinement makes least
  int num_coarse_samples = 100;                ///< points reflected in early iterations, >= 10
  int num_refine_samples = 10'000;             ///< points reflected in late iterations (the paper's figure), >= 10
  int max_iterations = 30;                     ///< of each stage, >= 1
  double merge_angle = 0.035;                  ///< radians, >= 0: planes that differ by no more than this in angle ...
  double merge_offset = 0.02;                  ///< ... and by this share of the radius in offset are one, >= 0
  double min_confidence = 0.5;                 ///< a plane is a symmetry if confidence >= min_confidence; in [0, 1]
  /// A plane is reported as possible if confidence >= min_possible; in [0, 1].
  double min_possible = 0.2;
  int max_possible = 5;  ///< symmetries and possible planes together, where there are possible ones, >= 1
  /// How far a symmetric surface may be off, as a share of the greatest distance between two points, in (0, 0.1]: a
  /// symmetry maps 97 % of the surface to within this of the surface.
  double tolerance = 0.01;
  /// Where the errors of a depth camera hide a tolerance, planes are decided at what the camera resolves, up to this
  /// share, in (0, 0.1]; at most `tolerance`: that one decides, and where the camera does not resolve it, symmetries
  /// are possible ones.
  double most_tolerance = 0.03;
  /// A tolerance in input units in place of both, >= 0; 0 = they decide.
  double absolute_tolerance = 0.0;
  bool families = true;  ///< planes through one axis or one center are reported as such in place of single planes
  bool turns = true;     ///< axes of turns of scans are searched too; false saves about a third of the time
  /// Reports the other maxima too, after the symmetries: approximate ones of the whole, and symmetries of parts.
  bool approximate = false;
  bool evidence = false;   ///< fills Detection::evidence; takes about as long again as the detection
  int max_planes = 64;     ///< >= 1; folds of rotations go up to 60
  std::uint64_t seed = 1;  ///< of all random draws; the same seed gives the same answer
  int num_threads = 0;     ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// What detectPlanes() found.
struct Detection {
  /// Why there is no answer, one sentence such as "12 distinct points, at least 20 are needed"; empty where the search
  /// ran, whatever it found.
  std::string reason;
  std::vector<SymmetryPlane> planes;  ///< symmetries, then possible, then approximate and local; each best first
  /// Where there is no symmetry and no possible one: the plane that maps the greatest share of the surface; else empty.
  std::optional<SymmetryPlane> best;
  /// Where 97 % of the points lie within the tolerance of one plane (three tolerances where noise hides the surface),
  /// as those of a sheet, a disc or one side of a box do: that plane. Reflections across it move nothing and say
  /// nothing.
  std::optional<ReflectionPlane> flat;
  double tolerance = 0.0;                       ///< that was decided at, input units
  double resolution = 0.0;                      ///< least tolerance that the sensor resolves, input units; 0 = not known
  double diameter = 0.0;                        ///< greatest distance between two points, input units
  std::vector<SymmetryAxis> axes;               ///< best first; their planes are not among planes
  std::vector<SymmetryCenter> centers;          ///< of spheres
  std::vector<SymmetryTurn> turns;              ///< of scans: axes of turns, most confident first, from min_possible on
  SymmetryMap map;                              ///< empty where one was given
  std::shared_ptr<DetectionEvidence> evidence;  ///< with DetectionOptions::evidence; else null
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// From points to planes: transform, maxima, refinement (Sections 4.1 to 4.4).
/// \param points 3 x N, finite, input units. Fewer than 20 distinct points, at one place or on one line give an empty
/// result with a reason. Of more than 20 000, as many decide as the tolerance needs.
/// \param make_search makes the search for the points that are used, once; null = FLANN's.
/// \param visibility what a scanner saw, input frame; null = the points show the object from all sides.
/// \param normals of the points, 3 x N, of any length and sign; one that is zero or not finite is estimated from the
/// neighbours, as are all where this is null.
/// \throws std::invalid_argument for bad options, coordinates that are not finite, or another number of normals.
Detection detectPlanes(const PointsRef& points, const DetectionOptions& options = {},
                       const MakeSearch& make_search = nullptr,
                       const Visibility* visibility = nullptr, const Points* normals = nullptr);

/// The planes of many clouds: each thread takes the next cloud and works on it alone. This keeps all cores busy, where
/// threads that share one cloud wait for each other between its stages.
/// \param num_clouds number of clouds.
/// \param cloud gives the points of cloud i in [0, num_clouds), as detectPlanes() takes them. Called once for each i,
/// from several threads at once.
/// \param found takes what detectPlanes() returns for cloud i. Called once for each i, by one thread at a time, in the
/// order in which the clouds are done.
/// \param options num_threads is the number of clouds that are worked on at once; 0 = one per core.
/// \throws std::invalid_argument as detectPlanes() does, and whatever cloud() and found() throw: the first exception,
/// when no thread works any more. Which of the other clouds are done then is not said.
void detectPlanesOfMany(std::size_t num_clouds, const std::function<Points(std::size_t)>& cloud,
                        const std::function<void(std::size_t, Detection)>& found, const DetectionOptions& options = {});

/// From a map that was made before to planes: maxima, refinement (Section 4.4).
/// \param points as in detectPlanes().
/// \param edt,map of these points.
/// \param make_search,visibility,normals as in detectPlanes().
/// \throws std::invalid_argument as detectPlanes() does.
Detection refineMaxima(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                       const DetectionOptions& options = {}, const MakeSearch& make_search = nullptr,
                       const Visibility* visibility = nullptr, const Points* normals = nullptr);

}  // namespace pcl_symmetry
