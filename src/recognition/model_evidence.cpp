#include "recognition/model_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/registration/pose_covariance.h"
#include "core/registration/pose_evidence.h"
#include "core/registration/visible_points.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

namespace {

/// Distance within which a scan and the surface of a model are one: what the scanner resolves.
/// \param radius of the model, > 0.
double modelTolerance(const PosedSurface& scan, double radius) {
  const double error = scan.seen ? scan.seen->depthError(scan.points.rowwise().mean().cast<double>()) : 0.0;
  const double tolerance = std::max(
      {kRecognition.min_tolerance * radius, kRecognition.noises * scan.noise, kRecognition.depth_errors * error});
  return std::min(tolerance, kRecognition.max_tolerance * radius);
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

}  // namespace pcl_symmetry::detail
