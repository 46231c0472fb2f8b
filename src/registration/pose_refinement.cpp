#include "registration/pose_refinement.h"

#include <algorithm>
#include <utility>

#include "core/registration/pose_scoring.h"
#include "core/registration/refinement/symmetric_icp.h"

namespace pcl_symmetry {

namespace {

// Points of the scan that ICP uses. chosen: half is less exact, twice takes twice the time.
constexpr int kRefinedPoints = 1000;
// Points of each cloud in the last comparison. chosen: half ranks close poses by chance, twice takes twice the time.
constexpr int kJudgedPoints = 3000;
// Accuracies, and radii at least: distance in which ICP looks for its first pairs. chosen: half finds too few pairs
// from coarse poses, twice pairs different parts.
constexpr double kReach = 4.0, kLeastReach = 0.08;
// Radii, least width of the last comparison; otherwise it is the accuracy. chosen: half takes sampling for differences,
// twice does not tell close poses apart.
constexpr double kLeastFinalWidth = 0.015;
// Merit behind the best pose at which poses are not refined. chosen: half drops poses that refinement would bring to
// the front, twice takes more time.
constexpr double kHopeless = 0.2;

}  // namespace

double refinementReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence) {
  return max_correspondence.value_or(std::max(kLeastReach, kReach * std::max(scan.accuracy, model.accuracy)));
}

Eigen::Isometry3d SearchFrames::toSearch(const Eigen::Isometry3d& T_target_source) const {
  Eigen::Isometry3d pose = T_target_source;
  pose.translation() = (T_target_source * source_center - target_center) / scale;
  return pose;
}

Eigen::Isometry3d SearchFrames::toInput(const Eigen::Isometry3d& T_target_source) const {
  Eigen::Isometry3d pose = T_target_source;
  pose.translation() = target_center + scale * T_target_source.translation() - T_target_source.linear() * source_center;
  return pose;
}

std::vector<RankedPose> refinePoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<RankedPose>& poses, const CloudRegistrationOptions& options) {
  const double accuracy = std::max(scan.accuracy, model.accuracy);
  SymmetricICPOptions icp;
  icp.num_points = kRefinedPoints;
  icp.reach = refinementReach(scan, model, options.max_correspondence);
  icp.max_iterations = options.max_iterations;
  icp.translation_epsilon = options.transformation_epsilon;
  // As PCL takes them: a cosine, which follows from the other one where it is not given.
  icp.rotation_epsilon =
      options.rotation_epsilon > 0.0 ? 1.0 - options.rotation_epsilon : options.transformation_epsilon;
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{kJudgedPoints, std::max(kLeastFinalWidth, accuracy), true};
  const auto judged = [&](const Eigen::Isometry3d& pose, int num_points) {
    return RankedPose{pose, scorer.score(pose, detail), num_points};
  };
  std::vector<RankedPose> refined;
  for (const RankedPose& pose : poses) {
    if (pose.score.merit() < poses.front().score.merit() - kHopeless) break;
    const RankedPose before = judged(pose.T_model_scan, pose.num_points);
    const RankedPose after = judged(refinedBySymmetricICP(scan, model, pose.T_model_scan, icp), kRefinedPoints);
    refined.push_back(after.score.merit() > before.score.merit() ? after : before);
  }
  const std::size_t size = refined.size();
  return distinctPoses(std::move(refined), size, options.search);
}

}  // namespace pcl_symmetry
