#include "recognition/posed_scan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/geometry/cloud_extent.h"
#include "core/matching/shape_signature.h"
#include "core/registration/pose_evidence.h"
#include "core/registration/pose_scoring.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

namespace {

/// Distance within which a scan and the surface of a model agree: the resolution of the scanner.
/// \param radius radius of the model, > 0.
double modelTolerance(const PosedSurface& scan, double radius) {
  const double error = scan.seen ? scan.seen->depthError(scan.points.rowwise().mean().cast<double>()) : 0.0;
  const double tolerance = std::max(
      {kRecognition.min_tolerance * radius, kRecognition.noises * scan.noise, kRecognition.depth_errors * error});
  return std::min(tolerance, kRecognition.max_tolerance * radius);
}

/// Whether \p b, the second of two poses of a model, explains more of the scan and of the depth image.
bool isWorse(const PosedModel& a, const PosedModel& b) {
  const auto explained = [](const RecognizedModel& model) {
    return model.evidence.on_model * model.evidence.shown * std::max(0.0, model.score.merit());
  };
  return explained(a.model) < explained(b.model);
}

}  // namespace

Eigen::Isometry3d posedInPicture(const PosedSurface& scan, const PosedSurface& model,
                                 const Eigen::Isometry3d& T_model_scan) {
  const double radius = boundingBall(model.points).radius, tolerance = modelTolerance(scan, radius);
  Eigen::Isometry3d T_scan_model = T_model_scan.inverse();
  for (int step = 0; step < kRecognition.picture_steps; ++step) {
    const double share = static_cast<double>(step) / (kRecognition.picture_steps - 1);
    const double reach = tolerance * std::pow(kRecognition.picture_reach, 1.0 - share);
    MotionEquations equations(1.0);
    for (const VisiblePoint& point : visiblePoints(model, scan, T_scan_model, kRecognition.num_judged_points, false)) {
      if (!(std::abs(point.height) < 2.0 * reach)) continue;
      const Eigen::Vector3d ray = (point.position - scan.seen->viewpoint()).normalized();
      const double along = point.normal.dot(ray) > 0.0 ? point.height : -point.height;
      const double weight = point.cosine * std::exp(-point.height * point.height / (reach * reach));
      equations.addPlane(point.position, point.position + along * point.normal, point.normal, weight);
    }
    T_scan_model = equations.motion() * T_scan_model;
  }
  return T_scan_model.inverse();
}

ModelEvidence modelEvidence(const PosedSurface& scan, const PosedSurface& model,
                            const Eigen::Isometry3d& T_model_scan) {
  const double radius = boundingBall(model.points).radius, tolerance = modelTolerance(scan, radius);
  const auto share = [](double part, double rest) { return part + rest > 0.0 ? part / (part + rest) : 0.0; };
  ModelEvidence evidence;
  double num_on = 0.0, num_off = 0.0;
  for (const float distance : discDistances(scan, model, T_model_scan, kRecognition.num_judged_points))
    if (distance < kRecognition.near * radius) ++(distance < tolerance ? num_on : num_off);
  evidence.on_model = share(num_on, num_off);

  double measured = 0.0, missing = 0.0;
  const std::vector<float> from_scan =
      discDistances(model, scan, T_model_scan.inverse(), kRecognition.num_judged_points);
  if (scan.seen) {
    for (const VisiblePoint& point :
         visiblePoints(model, scan, T_model_scan.inverse(), kRecognition.num_judged_points, true))
      (std::min<double>(std::abs(point.height), from_scan[point.index]) < tolerance ? measured : missing) +=
          point.cosine;
  } else {
    for (const float distance : from_scan) ++(distance < tolerance ? measured : missing);
  }
  evidence.shown = share(measured, missing);
  return evidence;
}

double sharedSurface(const PosedModel& a, const PosedModel& b) {
  const Eigen::Isometry3d T_b_a = b.T_surface_scan * a.T_surface_scan.inverse();
  const PoseScorer::Detail detail{kRecognition.num_compared_points, kRecognition.same_surface, true, true};
  return std::min(PoseScorer(*a.surface, *b.surface).score(T_b_a, detail).support,
                  PoseScorer(*b.surface, *a.surface).score(T_b_a.inverse(), detail).support);
}

CloudRegistrationOptions quickRegistration(int num_threads) {
  CloudRegistrationOptions options;
  options.frame = signatureFrameOptions();
  // The confidences of names were fitted to poses before these steps.
  options.search_parts = options.refine_closely = false;
  options.search.num_rotations = 200;
  options.search.num_screened = 16;
  options.search.num_refined = 6;
  options.search.max_poses = 2;
  options.num_threads = num_threads;
  return options;
}

PosedScan::PosedScan(const Points& points, const std::optional<Visibility>& seen, int num_threads)
    : options_(quickRegistration(num_threads)),
      ball_(boundingBall(points)),
      scale_(ball_.radius / kRecognition.seen_radius),
      surface_(surfaceOf(points, ball_.center,
                         seen ? std::optional(seen->normalized(ball_.center, scale_)) : std::nullopt)) {}

PosedModel PosedScan::withoutPose(const std::string& name, const Points& points) const {
  PosedModel model;
  model.model.name = name;
  model.frames = {ball_.center, boundingBall(points).center, scale_};
  model.surface = std::make_shared<const PosedSurface>(surfaceOf(points, model.frames.target_center, std::nullopt));
  return model;
}

PosedModel PosedScan::fitModel(const std::string& name, const Points& points,
                               const std::vector<Eigen::Isometry3d>& poses) const {
  const PosedModel model = withoutPose(name, points);
  std::vector<Eigen::Isometry3d> starts;
  for (const Eigen::Isometry3d& pose : poses) starts.push_back(model.frames.toSearch(pose));
  return fitModel(model, starts);
}

PosedModel PosedScan::fitModel(const PosedModel& model, const std::vector<Eigen::Isometry3d>& T_surface_scan) const {
  PoseSearchOptions search = options_.search;
  search.num_threads = options_.num_threads;
  search.num_rotations = 0;
  const std::vector<RankedPose> poses = searchPoses(surface_, *model.surface, T_surface_scan, search);
  std::vector<PosedModel> posed_models;
  for (const RankedPose& pose : refinePoses(surface_, *model.surface, poses, options_)) {
    posed_models.push_back(posed(model, pose.T_model_scan));
    if (surface_.seen)
      posed_models.push_back(posed(model, posedInPicture(surface_, *model.surface, pose.T_model_scan)));
  }
  return *std::max_element(posed_models.begin(), posed_models.end(), isWorse);
}

PosedModel PosedScan::rotated(const PosedModel& found) const {
  const PrincipalAxes principal = principalAxes(found.surface->points);
  std::vector<Eigen::Isometry3d> starts;
  for (int k = 0; k < 3; ++k) {
    for (int i = 1; i < kRecognition.num_rotations; ++i) {
      const Eigen::AngleAxisd rotation(2.0 * kPi * i / kRecognition.num_rotations, principal.axes.col(k));
      starts.push_back(Eigen::Translation3d(principal.center) * rotation * Eigen::Translation3d(-principal.center) *
                       found.T_surface_scan);
    }
  }
  const PosedModel other = fitModel(found, starts);
  return isWorse(found, other) ? other : found;
}

PosedModel PosedScan::judged(const std::string& name, const Points& points,
                             const Eigen::Isometry3d& T_model_scan) const {
  const PosedModel model = withoutPose(name, points);
  return posed(model, model.frames.toSearch(T_model_scan));
}

PosedModel PosedScan::posed(PosedModel model, const Eigen::Isometry3d& T_surface_scan) const {
  model.T_surface_scan = T_surface_scan;
  model.model.T_model_scan = model.frames.toInput(T_surface_scan);
  model.model.score = scoreOf(*model.surface, T_surface_scan);
  model.model.evidence = modelEvidence(surface_, *model.surface, T_surface_scan);
  return model;
}

PoseScore PosedScan::scoreOf(const PosedSurface& model, const Eigen::Isometry3d& T_model_scan) const {
  const double error = surface_.seen ? surface_.seen->depthError(Eigen::Vector3d::Zero()) : 0.0;
  const double width = std::max({kRecognition.min_width, surface_.accuracy, kRecognition.score_errors * error});
  return PoseScorer(surface_, model).score(T_model_scan, {kRecognition.num_judged_points, width, true, true});
}

PosedSurface PosedScan::surfaceOf(const Points& points, const Eigen::Vector3d& center,
                                  std::optional<Visibility> seen) const {
  return {normalizePoints(points, center, scale_), std::move(seen), options_.seed, options_.num_threads};
}

}  // namespace pcl_symmetry::detail
