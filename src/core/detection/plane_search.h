#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "core/detection/plane_families.h"
#include "core/detection/plane_measure.h"
#include "core/detection/standing_object.h"
#include "core/rotation/rotation_evidence.h"

namespace pcl_symmetry {

/// Combined evidence of the planes of a family.
struct JudgedFamily {
  double confidence = 0.0;      ///< confidence of the mean evidence
  double min_confidence = 1.0;  ///< least confidence of a single plane
  double score = 0.0, support = 0.0;
};

/// Fits, refines, measures and judges the planes of a cloud: decides which are symmetries and which are possible
/// (src/pages/algorithms/decision.md).
class PlaneSearch {
public:
  const NormalizedCloud& cloud;
  const Points& all_points;  ///< the points of the cloud and those removed to make it evenly dense, normalized frame
  const DetectionOptions& options;
  const PlaneFit fit{cloud, options};
  const PlaneMeasure measure{cloud, fit, options};
  /// Unit normals of the supports that carry the object of a scan.
  const std::vector<Eigen::Vector3d> support_normals;

  /// Cloud, points and options must outlive this object.
  PlaneSearch(const NormalizedCloud& given_cloud, const Points& points, const DetectionOptions& given_options)
      : cloud(given_cloud),
        all_points(points),
        options(given_options),
        support_normals(cloud.isScan() ? supportNormals(cloud.points, *cloud.seen()) : std::vector<Eigen::Vector3d>()) {
  }

  /// \param candidates after the last stage of refinement.
  /// \return one plane per candidate, in the same order.
  std::vector<MeasuredPlane> judge(const std::vector<Candidate>& candidates) const;

  /// The same for some of the candidates, replacing their previous judgments.
  void rejudge(const std::vector<Candidate>& candidates, const std::vector<char>& chosen,
               std::vector<MeasuredPlane>& judged) const;

  /// \param plane normalized frame.
  /// \param samples indices of the points that judge it.
  MeasuredPlane judge(const ReflectionPlane& plane, const std::vector<int>& samples) const;

  /// Judges the planes of a family together.
  /// \param planes normalized frame, at least one.
  /// \param samples indices of the points that judge them.
  JudgedFamily judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  /// Whether too many points are off the surface for a possible symmetry of a complete shape.
  bool isHopeless(const Candidate& candidate) const;

  /// Refines and judges candidates; re-judges those that hill climbing moved.
  std::vector<SymmetryPlane> refineAndJudge(std::vector<Candidate> candidates) const;

private:
  /// Sets the confidence of a plane from its evidence and the limits of the cloud.
  /// \param plane normalized frame.
  MeasuredPlane decide(MeasuredPlane measured, const ReflectionPlane& plane) const;
};

/// The evidence behind the decisions of one detection, to which confidences are fitted.
struct DetectionEvidence {
  /// Candidates after all stages of refinement, each plane once, best merit first. They do not depend on fitted
  /// numbers.
  std::vector<MeasuredPlane> planes;
  std::vector<JudgedRotation> rotations;  ///< of scans
};

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct RegularPolygon {
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
std::optional<RegularPolygon> polygonBySpectrum(const Points& all, const Line3d& line);

/// Results found so far, input frame.
struct DetectionState {
  Detection answer;
  std::optional<RegularPolygon> polygon;  ///< normalized frame; its planes are among the planes of the answer
  DetectionEvidence* evidence = nullptr;  ///< filled with the evidence of all candidates; may be null
};

/// The points that represent a large cloud, as many as the tolerance requires. They determine planes, decisions and
/// support; every other point takes the support of the nearest of them.
/// \param points 3 x N, finite, for which whyUnanswerable() is empty.
/// \return indices of points; nothing if all points are needed.
std::optional<std::vector<int>> drawSubset(const PointsRef& points, const DetectionOptions& options);

/// Gives each point of a cloud the support of the point that represents it.
/// \param representative_of for each point, the index of the point whose support it takes; -1: it supports nothing.
void spreadSupport(Detection& detection, const std::vector<int>& representative_of);

/// Thins a cloud until opposite sides are about equally dense.
///
/// Where noise hides the surface, planes are judged by the point density, so a cloud that is sparser on one side looks
/// as asymmetric as a shape that ends there. The logarithm of the density is fitted by a linear function of the
/// position. Variation of the shape itself is equal on both sides of a symmetry plane and remains.
/// \return indices in increasing order; all if the density is even.
std::vector<int> thinToEvenDensity(const NormalizedCloud& cloud, std::uint64_t seed);

/// The strongest local maxima of the map, one per basin of refinement, and the planes perpendicular to the principal
/// axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

/// \return the planes of the given kinds, in their order, transformed from the input frame to the normalized frame.
std::vector<ReflectionPlane> planesOf(const std::vector<SymmetryPlane>& planes, std::initializer_list<PlaneKind> kinds,
                                      const NormalizedCloud& cloud);

/// Completes the group that some symmetries generate: the reflection of one in another is a symmetry, too.
/// \param planes found so far, input frame; only symmetries are used.
/// \param[in,out] tried planes that were known or returned before, normalized frame.
/// \return the implied planes that are not among \p tried.
std::vector<Candidate> reflectSymmetries(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                         std::vector<ReflectionPlane>& tried);

/// Planes of a scan perpendicular to two of its symmetries, or to one of them and to its support, spread along the
/// object. Half of the surface that such a plane maps may be hidden, so that a map of few samples has no maximum there.
/// Not in the paper.
/// \param support_normals unit normals of the supports, as from supportNormals().
std::vector<Candidate> proposeAtRightAngles(const std::vector<SymmetryPlane>& planes,
                                            const std::vector<Eigen::Vector3d>& support_normals,
                                            const NormalizedCloud& cloud);

/// Finds the families that symmetries belong to: bodies of revolution and spheres replace their planes. A line-shaped
/// cloud gets its line as axis.
void findFamilies(const PlaneSearch& search, DetectionState& state);

/// Completes polygons. Planes of noisy clouds are judged jointly: all of them are symmetries or none is. Planes of
/// surfaces can be judged individually, but with many teeth they are too close to be found one by one.
void completePolygon(const PlaneSearch& search, DetectionState& state);

/// Finds symmetries of parts of a surface, such as planes 2 to 4 of Figure 8.
///
/// Departure from the paper: it takes them from local maxima of the transform of the whole shape, to which a small part
/// contributes too little. Here planes through the middles of balls of several radii, spread over the surface, are
/// refined on the points of their ball and then on the region that they map onto itself (MatchedRegions), which
/// distinguishes a part from a chance match.
///
/// With DetectionOptions::approximate, adds planes of PlaneKind::Local, unlike the symmetries and possible symmetries
/// found before.
void findPlanesOfParts(const PlaneSearch& search, DetectionState& state);

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// They are ordered as symmetries, then possible ones, both by decreasing confidence, then approximate and local ones
/// by decreasing support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return the planes, with the support of every point.
std::vector<SymmetryPlane> selectReported(const PlaneSearch& search, std::vector<SymmetryPlane> planes,
                                          const std::optional<RegularPolygon>& polygon = std::nullopt);

/// The plane of the whole shape with the greatest share, for shapes without a symmetry.
/// \param planes input frame.
/// \return a plane with the support of every point; nothing if a plane is a symmetry or a possible one, or there is no
/// plane.
std::optional<SymmetryPlane> bestApproximate(const PlaneSearch& search, const std::vector<SymmetryPlane>& planes);

/// Turns what was found into the answer: selects the planes to report, and fills the fields that describe the whole
/// cloud.
void report(const PlaneSearch& search, DetectionState& state);

/// Refines approximately known planes and decides each of them, without searching for others.
/// \param starts input frame.
/// \param input points and what a scanner saw.
std::vector<SymmetryPlane> decidePlanesNear(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                            const DetectionOptions& options);

/// detectPlanes(), with the evidence of its decisions.
/// \param evidence filled with the evidence of all candidates (doubles the time); may be null.
Detection detectWithEvidence(const PlaneInput& input, const DetectionOptions& options, DetectionEvidence* evidence);

}  // namespace pcl_symmetry
