#include "pcl_symmetry/core/pose_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/registration/pose_scoring.h"
#include "core/registration/pose_starts.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

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
