#include "pcl_symmetry/core/pose_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/small_motion.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/registration/pose_scoring.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// The anchor by which both clouds are aligned, along three directions of the scanner: the middle of the outline in the
/// image plane, and the front along the view.
Eigen::Vector3d anchorOf(const Eigen::Matrix3Xd& in_scanner) {
  const Eigen::Vector3d low = in_scanner.rowwise().minCoeff(), high = in_scanner.rowwise().maxCoeff();
  return {0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z()};
}

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

/// The evenly spread rotations of greatest merit.
std::vector<RankedPose> screened(const PoseStarts& starts, const PoseScorer& scorer, const PoseSearchOptions& options) {
  std::vector<RankedPose> poses;
  for (const Eigen::Matrix3d& rotation : uniformRotations(options.num_rotations))
    poses.push_back({Eigen::Isometry3d(rotation), {}});
  parallelBlocks(poses.size(), options.num_threads, [&](std::size_t i) {
    poses[i].T_model_scan = starts.pose(poses[i].T_model_scan.linear());
    poses[i].score = scorer.score(poses[i].T_model_scan, {kRegistration.screen_points, kRegistration.screen_width});
  });
  sortDescending(poses, [](const RankedPose& pose) { return pose.score.merit(); });
  poses.resize(std::min<std::size_t>(poses.size(), options.num_screened));
  return poses;
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

PoseStarts::PoseStarts(const PosedSurface& scan, const PosedSurface& model) : from_outline_(scan.seen.has_value()) {
  const auto size = std::min<Eigen::Index>(kRegistration.outline_points, model.points.cols());
  model_ = pointsAt(model.points, {model.order.begin(), model.order.begin() + size}).cast<double>();
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

void PoseSearchOptions::validate() const {
  check(num_rotations >= 0, "num_rotations", num_rotations, ">= 0");
  check(num_screened >= 1, "num_screened", num_screened, ">= 1");
  check(num_refined >= 1, "num_refined", num_refined, ">= 1");
  check(max_poses >= 1, "max_poses", max_poses, ">= 1");
  checkNumThreads(num_threads);
}

void RankedPose::improve(const PoseScorer& scorer, const PoseImprovement& how, double unit) {
  PoseScorer::Detail detail{how.num_points, 0.0};
  detail.unit = unit;
  for (int i = 0; i < how.num_steps; ++i) {
    const double share = static_cast<double>(i) / (how.num_steps - 1);
    detail.width = how.first_width * std::pow(how.last_width / how.first_width, share) * unit;
    T_model_scan = scorer.step(T_model_scan, detail);
  }
  score = scorer.score(T_model_scan, {how.num_points, how.last_width * unit});
  num_points = how.num_points;
}

std::vector<RankedPose> firstDistinct(const std::vector<RankedPose>& poses, std::size_t max_count, double radius) {
  std::vector<RankedPose> kept;
  for (const RankedPose& pose : poses) {
    const auto same = [&](const RankedPose& other) {
      const Eigen::Isometry3d motion = other.T_model_scan * pose.T_model_scan.inverse();
      return Eigen::AngleAxisd(motion.linear()).angle() < kRegistration.merge_angle &&
             motion.translation().norm() < kRegistration.merge_distance * radius;
    };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(pose);
    if (kept.size() == max_count) break;
  }
  return kept;
}

std::vector<RankedPose> distinctPoses(std::vector<RankedPose> poses, std::size_t max_count, double radius) {
  sortDescending(poses, [](const RankedPose& pose) { return pose.score.merit(); });
  return firstDistinct(poses, max_count, radius);
}

std::vector<RankedPose> searchPoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<Eigen::Isometry3d>& hypotheses,
                                    const PoseSearchOptions& options) {
  options.validate();
  const PoseScorer scorer(scan, model);
  std::vector<RankedPose> poses = screened(PoseStarts(scan, model), scorer, options);
  for (const Eigen::Isometry3d& hypothesis : hypotheses) poses.push_back({hypothesis, {}});

  const auto& rules = kRegistration;
  const double middle_width = std::sqrt(rules.coarse_width * rules.fine_width);
  const auto improve = [&](const PoseImprovement& how) {
    parallelBlocks(poses.size(), options.num_threads, [&](std::size_t i) { poses[i].improve(scorer, how); });
  };
  improve({rules.num_steps, rules.coarse_points, rules.coarse_width, middle_width});
  poses = distinctPoses(std::move(poses), options.num_refined);
  improve({rules.num_steps, rules.fine_points, middle_width, rules.fine_width});
  return distinctPoses(std::move(poses), options.max_poses);
}

}  // namespace pcl_symmetry
