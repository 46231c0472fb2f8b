#include "pcl_symmetry/registration/cloud_registration.h"

#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/stopwatch.h"
#include "core/frame/frame_hypotheses.h"

namespace pcl_symmetry {

namespace {

using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

constexpr int kRefinedPoints = 1000;        // of the scan
constexpr int kJudgedPoints = 3000;         // of each cloud
constexpr double kReach = 4.0;              // accuracies: how far ICP looks for its first pairs at least ...
constexpr double kLeastReach = 0.08;        // ... and in radii
constexpr double kLeastFinalWidth = 0.015;  // radii: of the last look, whose width is the accuracy
constexpr double kHopeless = 0.2;           // of merit behind the best before the refinement

NormalCloud::Ptr cloudOf(const PosedSurface& surface, int max_points) {
  const auto size = std::min<std::size_t>(surface.order.size(), max_points);
  auto cloud = pcl::make_shared<NormalCloud>();
  cloud->resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    (*cloud)[i].getVector3fMap() = surface.points.col(surface.order[i]);
    (*cloud)[i].getNormalVector3fMap() = surface.normals.col(surface.order[i]);
  }
  return cloud;
}

/// Point-to-plane ICP from several poses.
class Refinement {
public:
  Refinement(const PosedSurface& scan, const PosedSurface& model, double reach,
             const CloudRegistrationOptions& options) {
    const auto target = cloudOf(model, static_cast<int>(model.order.size()));
    auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>();
    tree->setInputCloud(target);
    icp_.setSearchMethodTarget(tree, true);
    icp_.setInputTarget(target);
    icp_.setInputSource(cloudOf(scan, kRefinedPoints));
    icp_.setUseSymmetricObjective(true);
    icp_.setEnforceSameDirectionNormals(true);
    icp_.setMaximumIterations(options.max_iterations);
    icp_.setMaxCorrespondenceDistance(reach);
    icp_.setTransformationEpsilon(options.transformation_epsilon);
    icp_.setTransformationRotationEpsilon(options.rotation_epsilon);
  }

  Eigen::Isometry3d refine(const Eigen::Isometry3d& start) {
    NormalCloud aligned;
    icp_.align(aligned, start.matrix());
    const Eigen::Isometry3d refined(icp_.getFinalTransformation());
    return refined.matrix().allFinite() ? refined : start;
  }

private:
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal, double> icp_;
};

void checkExtent(const char* name, const Points& points, const BoundingBall& ball) {
  if (points.cols() < 3 || !(ball.radius > 0.0))
    throw std::invalid_argument(std::string(name) + ": no extent, must have three different finite points");
}

}  // namespace

void CloudRegistrationOptions::validate() const {
  const auto check = [](bool valid, const char* field, double value, const char* rule) {
    if (!valid) throw std::invalid_argument(std::string(field) + " = " + std::to_string(value) + ", " + rule);
  };
  frame.validate();
  search.validate();
  check(max_iterations >= 1, "max_iterations", max_iterations, "must be >= 1");
  if (max_correspondence) check(*max_correspondence > 0.0, "max_correspondence", *max_correspondence, "must be > 0");
  check(transformation_epsilon >= 0.0, "transformation_epsilon", transformation_epsilon, "must be >= 0");
  check(num_threads >= 0, "num_threads", num_threads, "must be >= 0");
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

RankedPose refinePoses(const PosedSurface& scan, const PosedSurface& model, const std::vector<RankedPose>& poses,
                       const CloudRegistrationOptions& options) {
  const double accuracy = std::max(scan.accuracy, model.accuracy);
  Refinement icp(scan, model, options.max_correspondence.value_or(std::max(kLeastReach, kReach * accuracy)), options);
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{kJudgedPoints, std::max(kLeastFinalWidth, accuracy), true};
  RankedPose best;
  best.score.conflict = 1.0;
  const auto offer = [&](const Eigen::Isometry3d& pose) {
    const PoseScore score = scorer.score(pose, detail);
    if (score.merit() > best.score.merit()) best = {pose, score};
  };
  for (const RankedPose& pose : poses) {
    if (pose.score.merit() < poses.front().score.merit() - kHopeless) break;
    offer(pose.T_model_scan);
    offer(icp.refine(pose.T_model_scan));
  }
  return best;
}

CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options) {
  options.validate();
  PoseSearchOptions search = options.search;
  FrameOptions frame_options = options.frame;
  search.num_threads = frame_options.num_threads = frame_options.edt.num_threads = options.num_threads;
  frame_options.seed = options.seed;
  CloudRegistration result;
  Stopwatch watch;
  const auto done = [&](const char* stage) { result.timing_ms.emplace_back(stage, watch.lap()); };
  const BoundingBall source_ball = boundingBall(source), target_ball = boundingBall(target);
  checkExtent("source", source, source_ball);
  checkExtent("target", target, target_ball);
  // The scan is what has a viewpoint, the model what shows its object from all sides.
  const bool swapped = target_seen && !source_seen;
  const SearchFrames frames{source_ball.center, target_ball.center, swapped ? source_ball.radius : target_ball.radius};
  const auto surface = [&](const Points& points, const Eigen::Vector3d& center, const std::optional<Visibility>& seen) {
    return PosedSurface(normalizePoints(points, center, frames.scale),
                        seen ? std::optional(seen->normalized(center, frames.scale)) : std::nullopt, options.seed,
                        options.num_threads);
  };
  const PosedSurface source_surface = surface(source, frames.source_center, source_seen);
  const PosedSurface target_surface = surface(target, frames.target_center, target_seen);
  const PosedSurface& scan = swapped ? target_surface : source_surface;
  const PosedSurface& model = swapped ? source_surface : target_surface;
  const auto turnedRound = [&](const Eigen::Isometry3d& pose) { return swapped ? pose.inverse() : pose; };
  done("prepare");

  std::vector<Eigen::Isometry3d> hypotheses = {turnedRound(frames.toSearch(guess))};
  if (options.frames) {
    const auto frameOf = [&](const PosedSurface& of) {
      return symmetryFrame(of.points, frame_options, of.seen ? &*of.seen : nullptr);
    };
    for (const Eigen::Isometry3d& pose : frameHypotheses(frameOf(scan), frameOf(model))) {
      hypotheses.push_back(pose);
      hypotheses.push_back(poseFromRotation(pose.linear(), scan, model));
    }
    done("frames");
  }
  const std::vector<RankedPose> poses = searchPoses(scan, model, hypotheses, search);
  done("search");
  CloudRegistrationOptions refinement = options;
  if (options.max_correspondence) refinement.max_correspondence = *options.max_correspondence / frames.scale;
  const RankedPose best = refinePoses(scan, model, poses, refinement);
  done("refine");
  result.T_target_source = frames.toInput(turnedRound(best.T_model_scan));
  result.score = best.score;
  return result;
}

}  // namespace pcl_symmetry
