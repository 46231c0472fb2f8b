#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detection/plane_decision.h"
#include "core/detection/plane_lattice.h"

namespace pcl_symmetry {

struct DetectionEvidence;

/// A cloud, and what fits, refines, measures and judges its planes. Cloud, points and options must outlive it.
struct JudgedCloud {
  const NormalizedCloud& cloud;
  const Points& all_points;  ///< its points and those that were left out to make it evenly dense, normalized frame
  const DetectionOptions& options;
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(cloud, options);
  const StagedRefinement refinement{cloud, *fit, options};
  const PlaneMeasure measure{cloud, *fit, options};
  const PlaneDecision decision{cloud, measure, options};

  JudgedCloud(const NormalizedCloud& given_cloud, const Points& points, const DetectionOptions& given_options)
      : cloud(given_cloud), all_points(points), options(given_options) {}

  /// Refines and judges candidates; re-judges those that hill climbing moved.
  std::vector<SymmetryPlane> refinedAndJudged(std::vector<Candidate> candidates) const;
};

/// What was found up to now, input frame.
struct Found : Detection {
  std::optional<PlaneLattice> polygon;    ///< normalized frame; its planes are among the planes
  DetectionEvidence* evidence = nullptr;  ///< takes that of all candidates; null = not wanted
};

/// Refines planes that are nearly known and decides each of them; no others are searched.
/// \param starts input frame.
/// \param input points and what a scanner saw.
std::vector<SymmetryPlane> refinedAt(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                     const DetectionOptions& options);

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(const JudgedCloud& judged, std::vector<SymmetryPlane> planes,
                                        const std::optional<PlaneLattice>& polygon = std::nullopt);

/// \return the plane of a cloud that is a sheet at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const JudgedCloud& judged);

/// The answer where nothing is a symmetry: of the planes of the whole, the one with the greatest share.
/// \param planes input frame.
/// \return with the support of every point; empty where a plane is a symmetry or a possible one, or there is none.
std::optional<SymmetryPlane> bestApproximate(const JudgedCloud& judged, const std::vector<SymmetryPlane>& planes);

}  // namespace pcl_symmetry
