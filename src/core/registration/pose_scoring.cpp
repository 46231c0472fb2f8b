#include "core/registration/pose_scoring.h"

#include <algorithm>
#include <cmath>

#include "core/base/symmetric_solvers.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

float gaussian(double distance, double width) {
  return static_cast<float>(std::exp(-distance * distance / (width * width)));
}

/// The Gaussian of the distance of a point from its closest point, or from the disc about it.
float nearness(const Landing& landing, Eigen::Index i, const PosedSurface& to, double width, bool from_disc = false) {
  const float sq_distance = from_disc ? to.sqDiscDistance(landing, i)
                                      : (to.points.col(landing.closest[i]) - landing.images.col(i)).squaredNorm();
  return std::exp(static_cast<float>(-1.0 / (width * width)) * sq_distance);
}

/// Factor of the normal on a point's support: 1 if it is parallel to that of the closest point.
float normalFactor(const PosedSurface& from, const Landing& landing, Eigen::Index i, const PosedSurface& to) {
  const float cosine = std::max(0.0f, normalCosine(from, to, landing, i));
  return 1.0f - kRegistration.normal_share + kRegistration.normal_share * cosine * cosine;
}

/// Depth of a point behind the visible surface. A depth camera misses surfaces: pixels without a depth are
/// uninformative.
double depthBehind(const Landing& landing, Eigen::Index i, const PosedSurface& to) {
  const Eigen::Vector3d x = landing.images.col(i).cast<double>();
  const double depth = to.seen->depthBehind(x);
  return std::isinf(depth) && to.seen->depthError(x) > 0.0 ? std::abs(depth) : depth;
}

}  // namespace

Eigen::Isometry3d MotionEquations::motion() const {
  constexpr int last = WeightedProducts::kLast;
  const WeightedProducts::Matrix planes = of_planes_.sums(), points = of_points_.sums();
  const Eigen::Matrix3d arms = points.topLeftCorner<3, 3>(), rotated = points.block<3, 3>(0, 3);
  Matrix6d hessian = of_planes_.ofUnknowns();
  hessian.topLeftCorner<3, 3>() += arms.trace() * Eigen::Matrix3d::Identity() - arms;
  hessian.block<3, 3>(3, 0) -= crossMatrix(points.block<3, 1>(0, last));
  hessian.bottomRightCorner<3, 3>().diagonal().array() += points(last, last);
  Vector6d gradient = planes.block<last, 1>(0, last);
  gradient.head<3>() +=
      Eigen::Vector3d(rotated(1, 2) - rotated(2, 1), rotated(2, 0) - rotated(0, 2), rotated(0, 1) - rotated(1, 0));
  gradient.tail<3>() += points.block<3, 1>(3, last);
  hessian.diagonal().array() += kRegistration.inertia + kRegistration.relative_inertia * hessian.diagonal().maxCoeff();
  Vector6d motion = solveSymmetric(hessian, gradient);
  if (!motion.allFinite()) return Eigen::Isometry3d::Identity();
  motion.tail<3>() *= unit_;
  return motionBy(motion);
}

PoseScore PoseScorer::score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  PoseScore score;
  const Landing on_model = land(scan_, model_, T_model_scan, detail.num_points, detail.exact);
  double unexplained = 0.0;
  for (Eigen::Index i = 0; i < on_model.images.cols(); ++i) {
    const float near = nearness(on_model, i, model_, detail.width, detail.from_surface);
    score.support += detail.from_surface ? near : near * normalFactor(scan_, on_model, i, model_);
    if (model_.seen && depthBehind(on_model, i, model_) < 0.0) unexplained += 1.0 - near;
  }
  score.support /= static_cast<double>(on_model.images.cols());
  score.conflict = unexplained / static_cast<double>(on_model.images.cols());
  if (!scan_.seen) return score;
  const Landing on_scan = land(model_, scan_, T_model_scan.inverse(), detail.num_points, detail.exact);
  double conflict = 0.0, judged = kRegistration.min_judged * static_cast<double>(on_scan.images.cols());
  for (Eigen::Index i = 0; i < on_scan.images.cols(); ++i) {
    const double depth = depthBehind(on_scan, i, scan_);
    // The scanner may have measured more of the object beside the scan: a piece that was cut off.
    double on_surface = nearness(on_scan, i, scan_, detail.width, detail.from_surface);
    if (detail.from_surface) on_surface = std::max<double>(on_surface, gaussian(depth, detail.width));
    conflict += depth < 0.0 ? 1.0 - on_surface : 0.0;
    judged += depth < 0.0 ? 1.0 : on_surface;
  }
  score.conflict += conflict / judged;
  return score;
}

Eigen::Isometry3d PoseScorer::step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  MotionEquations equations(detail.unit);
  const Landing on_model = land(scan_, model_, T_model_scan, detail.num_points, detail.exact);
  for (Eigen::Index i = 0; i < on_model.images.cols(); ++i) {
    const int j = on_model.closest[i];
    const double weight = nearness(on_model, i, model_, detail.width) * normalFactor(scan_, on_model, i, model_);
    const Eigen::Vector3d x = on_model.images.col(i).cast<double>(), y = model_.points.col(j).cast<double>();
    equations.addPlane(x, y, model_.normals.col(j).cast<double>(), (1.0 - kRegistration.point_share) * weight);
    equations.addPoint(x, y, kRegistration.point_share * weight);
  }
  if (scan_.seen) {
    const Landing on_scan = land(model_, scan_, T_model_scan.inverse(), detail.num_points, detail.exact);
    const double share =
        kRegistration.silhouette_share * static_cast<double>(on_model.images.cols()) / on_scan.images.cols();
    for (Eigen::Index i = 0; i < on_scan.images.cols(); ++i) {
      if (depthBehind(on_scan, i, scan_) >= 0.0) continue;
      const double weight = nearness(on_scan, i, scan_, detail.width);
      const Eigen::Vector3d moving = T_model_scan * scan_.points.col(on_scan.closest[i]).cast<double>();
      equations.addPoint(moving, model_.points.col(model_.order[i]).cast<double>(), share * weight);
    }
  }
  return equations.motion() * T_model_scan;
}

}  // namespace pcl_symmetry
