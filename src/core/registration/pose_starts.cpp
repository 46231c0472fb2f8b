#include "core/registration/pose_starts.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/small_motion.h"
#include "core/geometry/directions.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// The anchor by which both clouds are aligned, along three directions of the scanner: the middle of the outline in the
/// image plane, and the front along the view.
Eigen::Vector3d anchorOf(const Eigen::Matrix3Xd& in_scanner) {
  const Eigen::Vector3d low = in_scanner.rowwise().minCoeff(), high = in_scanner.rowwise().maxCoeff();
  return {0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z()};
}

Eigen::Matrix3Xd sampleOf(const PosedSurface& surface) {
  const auto size = std::min<Eigen::Index>(kRegistration.outline_points, surface.points.cols());
  Eigen::Matrix3Xd sample(3, size);
  for (Eigen::Index i = 0; i < size; ++i) sample.col(i) = surface.points.col(surface.order[i]).cast<double>();
  return sample;
}

}  // namespace

std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations) {
  constexpr double psi = 1.533751168755204288118041;  // second irrational of the spirals beside sqrt(2): the positive
                                                      // root of psi^4 = psi + 4
  std::vector<Eigen::Matrix3d> rotations;
  for (int i = 0; i < num_rotations; ++i) {
    const double s = i + 0.5, share = s / num_rotations;
    const double a = 2.0 * kPi * s / std::sqrt(2.0), b = 2.0 * kPi * s / psi;
    const double inner = std::sqrt(share), outer = std::sqrt(1.0 - share);
    rotations.push_back(
        Eigen::Quaterniond(outer * std::cos(b), inner * std::sin(a), inner * std::cos(a), outer * std::sin(b))
            .toRotationMatrix());
  }
  return rotations;
}

PoseStarts::PoseStarts(const PosedSurface& scan, const PosedSurface& model)
    : from_outline_(scan.seen.has_value()), model_(sampleOf(model)) {
  if (!from_outline_) {
    scan_anchor_ = centerOfMass(scan.points);
    model_anchor_ = centerOfMass(model.points);
    return;
  }
  R_scanner_scan_ = viewingFrame((centerOfMass(scan.points) - scan.seen->viewpoint()).normalized());
  scan_anchor_ = R_scanner_scan_.transpose() * anchorOf(R_scanner_scan_ * scan.points.cast<double>());
}

Eigen::Isometry3d PoseStarts::pose(const Eigen::Matrix3d& R_model_scan) const {
  Eigen::Vector3d anchor = model_anchor_;
  if (from_outline_) {
    const Eigen::Matrix3d R_scanner_model = R_scanner_scan_ * R_model_scan.transpose();
    anchor = R_scanner_model.transpose() * anchorOf(R_scanner_model * model_);
  }
  return isometry(R_model_scan, anchor - R_model_scan * scan_anchor_);
}

namespace {

/// The rotations that represent all rotations about an axis of revolution; the identity alone if there is no such axis.
std::vector<Eigen::Matrix3d> rotationsOf(const SymmetryFrame& frame) {
  const bool is_round = frame.revolution_axis >= 0 && frame.revolution_axis < 3;
  std::vector<Eigen::Matrix3d> rotations{Eigen::Matrix3d::Identity()};
  for (int k = 1; is_round && k < kRegistration.num_rotations; ++k)
    rotations.push_back(
        Eigen::AngleAxisd(2.0 * kPi * k / kRegistration.num_rotations, Eigen::Vector3d::Unit(frame.revolution_axis))
            .toRotationMatrix());
  return rotations;
}

}  // namespace

std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b) {
  const Eigen::Isometry3d T_b_canonical = b.T_canonical_input.inverse();
  const std::vector<Eigen::Matrix3d> about_axis = rotationsOf(a);
  std::vector<Eigen::Isometry3d> hypotheses;
  const auto add = [&](const Eigen::Isometry3d& hypothesis) {
    const auto same = [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(other.linear().transpose() * hypothesis.linear()).angle() < kRegistration.same_rotation;
    };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), same)) hypotheses.push_back(hypothesis);
  };
  for (const Eigen::Matrix3i& order : axisRotations()) {
    for (const Eigen::Matrix3d& rotation : about_axis) {
      const Eigen::Isometry3d rotated(Eigen::Matrix3d(order.cast<double>() * rotation));
      for (std::size_t i = 0; i < a.num_maxima; ++i) add(T_b_canonical * rotated * a.equivalent[i]);
    }
  }
  return hypotheses;
}

}  // namespace pcl_symmetry
