#include "registration/pose_refinement.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include <algorithm>
#include <utility>

#include "core/base/small_motion.h"
#include "core/geometry/point_samples.h"
#include "core/registration/pose_scoring.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

struct PoseRefinementRules {
  int refined_points = 1000;  ///< points of the scan that ICP uses
  double reach = 4.0;         ///< greatest distance of ICP's first pairs, accuracies of the surfaces
  double min_reach = 0.08;    ///< least value of that distance, radii
  /// Deficit in merit that the closest pose may have: the comparison is coarser than that pose.
  double same_merit = 0.01;
  /// Least width of the Gaussian of the last comparison, radii; otherwise it is the accuracy.
  double min_width = 0.015;
  double hopeless = 0.2;  ///< deficit in merit to the best pose above which poses are not refined
  /// Least number of pairs, which determine a motion of six parameters; with fewer, PCL's ICP prints to stderr.
  std::size_t min_pairs = WeightedProducts::kLast;
};
constexpr PoseRefinementRules kPoseRefinement;

/// \param points indices of the points.
NormalCloud::Ptr cloudOf(const PosedSurface& surface, const std::vector<int>& points) {
  auto cloud = pcl::make_shared<NormalCloud>();
  cloud->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    (*cloud)[i].getVector3fMap() = surface.points.col(points[i]);
    (*cloud)[i].getNormalVector3fMap() = surface.normals.col(points[i]);
  }
  return cloud;
}

/// Points spread over the scan.
NormalCloud::Ptr fewPoints(const PosedSurface& scan) {
  const auto size = std::min<std::size_t>(scan.order.size(), kPoseRefinement.refined_points);
  return cloudOf(scan, {scan.order.begin(), scan.order.begin() + size});
}

/// Pairs of closest points, all at once and by the search of the model. PCL's own estimation queries FLANN point by
/// point: for a frame of eight recognized objects it took 0.6 s of 3.7 s, this takes 0.1 s, with the same pairs.
class ModelCorrespondences
    : public pcl::registration::CorrespondenceEstimation<pcl::PointNormal, pcl::PointNormal, double> {
public:
  explicit ModelCorrespondences(ClosestPointSearch::Ptr model) : model_(std::move(model)) {}

  void determineCorrespondences(pcl::Correspondences& pairs, double max_distance) override {
    const NormalCloud& scan = *getInputSource();
    Points positions(3, scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) positions.col(i) = scan[i].getVector3fMap();
    pairs.clear();
    closest_.resize(scan.size(), -1);
    std::vector<float> sq_distances;
    if (positions.allFinite())  // otherwise the step was unconstrained, and its result is discarded
      model_->searchWithin(positions, static_cast<float>(max_distance * max_distance), closest_, sq_distances);
    for (std::size_t i = 0; i < sq_distances.size(); ++i)
      if (closest_[i] >= 0) pairs.emplace_back(static_cast<int>(i), closest_[i], sq_distances[i]);
    for (std::size_t i = 0; pairs.size() < std::min(kPoseRefinement.min_pairs, scan.size()); ++i)
      pairs.emplace_back(static_cast<int>(i), std::max(0, closest_[i]), 0.0f);
  }

private:
  ClosestPointSearch::Ptr model_;
  std::vector<int> closest_;  // result of the last call, from which the next one begins
};

/// Point-to-plane ICP from several poses.
class PoseRefinement {
public:
  PoseRefinement(const PosedSurface& scan, const PosedSurface& model, double reach,
                 const CloudRegistrationOptions& options) {
    // This tree is not used.
    icp_.setSearchMethodTarget(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>(), true);
    icp_.setCorrespondenceEstimation(pcl::make_shared<ModelCorrespondences>(model.search));
    icp_.setInputTarget(cloudOf(model, allIndices(model.points.cols())));
    icp_.setInputSource(fewPoints(scan));
    icp_.setUseSymmetricObjective(true);
    icp_.setEnforceSameDirectionNormals(true);
    icp_.setMaximumIterations(options.max_iterations);
    icp_.setMaxCorrespondenceDistance(reach);
    icp_.setTransformationEpsilon(options.transformation_epsilon);
    icp_.setTransformationRotationEpsilon(options.rotation_epsilon);
  }

  /// \return the refined T_model_scan; \p start if ICP fails.
  Eigen::Isometry3d refined(const Eigen::Isometry3d& start) {
    NormalCloud aligned;
    icp_.align(aligned, start.matrix());
    const Eigen::Isometry3d pose(icp_.getFinalTransformation());
    return pose.matrix().allFinite() ? pose : start;
  }

private:
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal, double> icp_;
};

}  // namespace

double refinementReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence) {
  return max_correspondence.value_or(
      std::max(kPoseRefinement.min_reach, kPoseRefinement.reach * std::max(scan.accuracy, model.accuracy)));
}

double closestReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence) {
  return std::min(refinementReach(scan, model, max_correspondence), std::max(scan.accuracy, model.accuracy));
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

PoseScore lastScore(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan) {
  const double width = std::max({kPoseRefinement.min_width, scan.accuracy, model.accuracy});
  return PoseScorer(scan, model).score(T_model_scan, {kRegistration.evidence_points, width, true});
}

std::vector<RankedPose> closestPoses(const PosedSurface& scan, const PosedSurface& model,
                                     const std::vector<Eigen::Isometry3d>& starts,
                                     const CloudRegistrationOptions& options) {
  PoseRefinement icp(scan, model, closestReach(scan, model, options.max_correspondence), options);
  std::vector<RankedPose> poses;
  for (const Eigen::Isometry3d& start : starts)
    poses.push_back({icp.refined(start), {}, kPoseRefinement.refined_points});
  return poses;
}

RankedPose closestPose(const PosedSurface& scan, const PosedSurface& model, const RankedPose& pose,
                       const CloudRegistrationOptions& options) {
  RankedPose closest = closestPoses(scan, model, {pose.T_model_scan}, options).front();
  closest.score = lastScore(scan, model, closest.T_model_scan);
  return closest.score.merit() < pose.score.merit() - kPoseRefinement.same_merit ? pose : closest;
}

std::vector<RankedPose> refinePoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<RankedPose>& poses, const CloudRegistrationOptions& options) {
  PoseRefinement icp(scan, model, refinementReach(scan, model, options.max_correspondence), options);
  const auto judged = [&](const Eigen::Isometry3d& pose, int num_points) {
    return RankedPose{pose, lastScore(scan, model, pose), num_points};
  };
  std::vector<RankedPose> refined;
  for (const RankedPose& pose : poses) {
    if (pose.score.merit() < poses.front().score.merit() - kPoseRefinement.hopeless) break;
    const RankedPose before = judged(pose.T_model_scan, pose.num_points);
    const RankedPose after = judged(icp.refined(pose.T_model_scan), kPoseRefinement.refined_points);
    refined.push_back(after.score.merit() > before.score.merit() ? after : before);
  }
  return distinctPoses(std::move(refined));
}

}  // namespace pcl_symmetry
