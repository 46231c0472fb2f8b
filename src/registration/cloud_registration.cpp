#include "pcl_symmetry/registration/cloud_registration.h"

#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include "pcl_symmetry/core/frame_hypotheses.h"
#include <chrono>
#include <stdexcept>

namespace pcl_symmetry {

namespace {

using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

constexpr int kRefinedPoints = 2000;  // of the scan
constexpr int kJudgedPoints = 3000;   // of each cloud
constexpr double kReach = 4.0;        // accuracies: how far ICP looks for its first pairs at least ...
constexpr double kLeastReach = 0.08;  // ... and in radii
constexpr double kFinalWidth = 1.0, kLeastFinalWidth = 0.015;  // accuracies, radii: of the last look

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
  Refinement(const PosedSurface& scan, const PosedSurface& model, double reach, const RefinementOptions& options) {
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

class Stopwatch {
public:
  /// Milliseconds since the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Between the input frames and those of the search, which are about the centers and in radii of the model.
struct SearchFrames {
  BoundingBall source, target;
  double scale;

  PosedSurface surface(const Points& points, const BoundingBall& ball, const std::optional<Visibility>& seen,
                       std::uint64_t seed, int num_threads) const {
    std::optional<Visibility> own;
    if (seen) own = seen->normalized(ball.center, scale);
    return {normalizePoints(points, ball.center, scale), std::move(own), seed, num_threads};
  }

  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const {
    Eigen::Isometry3d pose = T_target_source;
    pose.translation() = (T_target_source * source.center - target.center) / scale;
    return pose;
  }

  Eigen::Isometry3d toInput(const Eigen::Isometry3d& pose) const {
    Eigen::Isometry3d T_target_source = pose;
    T_target_source.translation() = target.center + scale * pose.translation() - pose.linear() * source.center;
    return T_target_source;
  }
};

void checkExtent(const char* name, const Points& points, const BoundingBall& ball) {
  if (points.cols() < 3 || !(ball.radius > 0.0))
    throw std::invalid_argument(std::string(name) + ": no extent, must have three different finite points");
}

}  // namespace

CloudRegistration registerClouds(const Points& source, std::optional<Visibility> source_seen, const Points& target,
                                 std::optional<Visibility> target_seen, const Eigen::Isometry3d& guess,
                                 const PoseSearchOptions& search, const RefinementOptions& refinement,
                                 std::uint64_t seed) {
  CloudRegistration result;
  Stopwatch watch;
  const auto done = [&](const char* stage) { result.timing_ms.emplace_back(stage, watch.lap()); };
  SearchFrames frames{boundingBall(source), boundingBall(target), 1.0};
  checkExtent("source", source, frames.source);
  checkExtent("target", target, frames.target);
  // The scan is what has a viewpoint, the model what shows its object from all sides.
  const bool swapped = target_seen && !source_seen;
  frames.scale = swapped ? frames.source.radius : frames.target.radius;
  const PosedSurface source_surface = frames.surface(source, frames.source, source_seen, seed, search.num_threads);
  const PosedSurface target_surface = frames.surface(target, frames.target, target_seen, seed, search.num_threads);
  const PosedSurface& scan = swapped ? target_surface : source_surface;
  const PosedSurface& model = swapped ? source_surface : target_surface;
  const auto turnedRound = [&](const Eigen::Isometry3d& pose) { return swapped ? pose.inverse() : pose; };
  done("prepare");

  std::vector<Eigen::Isometry3d> hypotheses = {turnedRound(frames.toSearch(guess))};
  if (!getenv("NOSYM")) {
  const auto frameOf = [&](const PosedSurface& surface) {
    FrameOptions fo; fo.num_threads=fo.edt.num_threads=search.num_threads;
    return symmetryFrame(surface.points, fo, surface.seen ? &*surface.seen : nullptr);
  };
  const auto fs = frameOf(scan);
  done("scan_frame");
  const auto fm = frameOf(model);
  done("model_frame");
  for (const auto& hypothesis : frameHypotheses(fs, fm)) {
    if (getenv("SYMCENTER")) hypotheses.push_back(hypothesis);
    else hypotheses.push_back(poseFromRotation(hypothesis.linear(), scan, model));
  }
  }
  PoseSearchOptions search2 = search;
  if (getenv("NROT")) search2.num_rotations = atoi(getenv("NROT"));
  if (getenv("NSCR")) search2.num_screened = atoi(getenv("NSCR"));
  if (getenv("NREF")) search2.num_refined = atoi(getenv("NREF"));
  if (getenv("NPOS")) search2.max_poses = atoi(getenv("NPOS"));
  const std::vector<RankedPose> poses = searchPoses(scan, model, hypotheses, search2);
  done("search");

  const double accuracy = std::max(scan.accuracy, model.accuracy);
  const double reach = refinement.max_correspondence ? *refinement.max_correspondence / frames.scale
                                                     : std::max(kLeastReach, kReach * accuracy);
  Refinement icp(scan, model, reach, refinement);
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{kJudgedPoints, std::max(kLeastFinalWidth, kFinalWidth * accuracy), true};
  RankedPose best;
  best.score.conflict = 1.0;
  for (const RankedPose& pose : poses) {
    const Eigen::Isometry3d refined = icp.refine(pose.T_model_scan);
    for (const Eigen::Isometry3d& candidate : {pose.T_model_scan, refined}) {
      const PoseScore score = scorer.score(candidate, detail);
      if (score.merit() > best.score.merit()) best = {candidate, score};
    }
  }
  done("refine");
  if (getenv("TIMING")) { for (auto& [n,ms] : result.timing_ms) fprintf(stderr,"%s %.0f ", n.c_str(), ms); fprintf(stderr,"\n"); }
  result.T_target_source = frames.toInput(turnedRound(best.T_model_scan));
  result.score = best.score;
  return result;
}

}  // namespace pcl_symmetry
