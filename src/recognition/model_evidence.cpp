#include "recognition/model_evidence.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/registration/pose_covariance.h"
#include "core/registration/pose_evidence.h"
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

/// A point of a model that nothing of the model hides from a scanner, in the frame of the scan.
struct VisiblePoint {
  Eigen::Index index;  ///< in the order of the model
  Eigen::Vector3d position, normal;
  double cosine;  ///< between its normal and its ray: the area that the scanner sees of it
  double height;  ///< along the normal, of what was measured on its ray; positive in free space; infinite: nothing was
};

/// Whether a picture shows something before a point, or beside it: pictures that are made of points have gaps, through
/// which a point at the back is seen.
/// \param margin least distance of what is before the point.
/// \param beside how far it may be beside the point; 0 = only on its ray.
bool isHidden(const Visibility& picture, const Eigen::Vector3d& x, const Eigen::Vector3d& ray, double margin,
              double beside) {
  const Eigen::Vector3d u = beside * ray.unitOrthogonal(), v = ray.cross(u);
  const auto isBehind = [&](const Eigen::Vector3d& at) { return picture.depthBehind(at) > margin; };
  return isBehind(x) || (beside > 0.0 && (isBehind(x + u) || isBehind(x - u) || isBehind(x + v) || isBehind(x - v)));
}

/// \param scan with what its scanner saw.
/// \param beside see isHidden(); surely visible points are fewer.
std::vector<VisiblePoint> visiblePoints(const PosedSurface& scan, const PosedSurface& model,
                                        const Eigen::Isometry3d& T_scan_model, double radius, double beside) {
  const auto size = std::min<Eigen::Index>(kRecognition.num_judged_points, model.points.cols());
  const Eigen::Isometry3f pose = T_scan_model.cast<float>();
  Points positions(3, size);
  for (Eigen::Index i = 0; i < size; ++i) positions.col(i) = pose * model.points.col(model.order[i]);
  const Eigen::Vector3d viewpoint = scan.seen->viewpoint();
  const std::optional<Visibility> of_model = Visibility::fromPoints(positions, viewpoint);
  std::vector<VisiblePoint> visible;
  for (Eigen::Index i = 0; of_model && i < size; ++i) {
    const Eigen::Vector3d x = positions.col(i).cast<double>(), ray = (x - viewpoint).normalized();
    const Eigen::Vector3d n = (pose.linear() * model.normals.col(model.order[i])).cast<double>();
    const double cosine = std::abs(n.dot(ray));
    if (cosine < kRecognition.min_cosine || isHidden(*of_model, x, ray, kRecognition.hidden_depth * radius, beside))
      continue;
    visible.push_back({i, x, n, cosine, -scan.seen->depthBehind(x) * cosine});
  }
  return visible;
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
    for (const VisiblePoint& point : visiblePoints(scan, model, T_scan_model, radius, 0.0)) {
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
    // Pictures that are made of points have gaps between them.
    for (const VisiblePoint& point :
         visiblePoints(scan, model, T_model_scan.inverse(), radius, kRecognition.hidden_depth * radius))
      (std::min<double>(std::abs(point.height), from_scan[point.index]) < tolerance ? measured : missing) +=
          point.cosine;
  } else {
    for (const float distance : from_scan) ++(distance < tolerance ? measured : missing);
  }
  evidence.shown = share(measured, missing);
  return evidence;
}

}  // namespace pcl_symmetry::detail
