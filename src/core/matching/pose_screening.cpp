#include "core/matching/pose_screening.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/matching/matching_rules.h"
#include "core/registration/pose_scoring.h"

namespace pcl_symmetry {

namespace {

/// A pose of one of the shapes, about the centers.
struct Trial {
  std::size_t shape;
  RankedPose pose;
};

/// Calls judge(pose, scorer, radius of the shape) for each trial and sorts them, best first.
template <typename Judge>
void judgeAll(std::vector<Trial>& trials, const ScreenedSurface& scan, const std::vector<PosesOfShape>& shapes,
              int num_threads, const Judge& judge) {
  parallelRanges(trials.size(), 64, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ScreenedSurface& shape = *shapes[trials[i].shape].shape;
      judge(trials[i].pose, PoseScorer(scan.surface, shape.surface), shape.ball.radius);
    }
  });
  sortDescending(trials, [](const Trial& entry) { return entry.pose.score.merit(); });
}

/// All poses of shapes that have a size.
std::vector<Trial> trialsOf(const ScreenedSurface& scan, const std::vector<PosesOfShape>& shapes) {
  std::vector<Trial> trials;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    if (!(shapes[k].shape->ball.radius > 0.0)) continue;
    for (Eigen::Isometry3d pose : shapes[k].T_shape_scan) {
      pose.translation() = pose * scan.ball.center - shapes[k].shape->ball.center;
      trials.push_back({k, {pose, {}, 0}});
    }
  }
  return trials;
}

/// The distinct ones of the poses of a shape, in input frames.
std::vector<Eigen::Isometry3d> distinctInInput(std::vector<RankedPose> poses, const ScreenedSurface& scan,
                                               const ScreenedSurface& shape, int num_poses) {
  std::vector<Eigen::Isometry3d> found;
  for (const RankedPose& pose :
       distinctPoses(std::move(poses), static_cast<std::size_t>(num_poses), shape.ball.radius)) {
    found.push_back(pose.T_model_scan);
    found.back().translation() += shape.ball.center - pose.T_model_scan.linear() * scan.ball.center;
  }
  return found;
}

}  // namespace

ScreenedSurface::ScreenedSurface(const SurfacePoints& points, const std::optional<Visibility>& seen)
    : ball(boundingBall(points.points)),
      surface(normalizePoints(points.points, ball.center, 1.0), points.normals,
              seen ? std::optional(seen->normalized(ball.center, 1.0)) : std::nullopt) {}

std::vector<ScreenedShape> screenPoses(const ScreenedSurface& scan, const std::vector<PosesOfShape>& shapes,
                                       const PoseScreeningOptions& options) {
  std::vector<Trial> trials = trialsOf(scan, shapes);
  judgeAll(trials, scan, shapes, options.num_threads, [](RankedPose& pose, const PoseScorer& scorer, double radius) {
    pose.score = scorer.score(pose.T_model_scan, {kMatching.num_judged_points, kMatching.judged_width * radius});
  });
  trials.resize(std::min<std::size_t>(trials.size(), kMatching.num_improved));
  const PoseImprovement improvement{kMatching.num_steps, kMatching.num_improved_points, kMatching.first_width,
                                    kMatching.last_width};
  judgeAll(trials, scan, shapes, options.num_threads, [&](RankedPose& pose, const PoseScorer& scorer, double radius) {
    pose.improve(scorer, improvement, radius);
  });

  std::vector<std::vector<RankedPose>> of_shape(shapes.size());
  std::vector<ScreenedShape> found;
  for (const Trial& trial : trials) {
    std::vector<RankedPose>& poses = of_shape[trial.shape];
    const bool is_behind = trial.pose.score.merit() < trials.front().pose.score.merit() - options.max_behind;
    const std::size_t max_count = is_behind ? std::min(options.min_shapes, options.num_shapes) : options.num_shapes;
    if (poses.empty() && found.size() < max_count) found.push_back({static_cast<int>(trial.shape), {}});
    poses.push_back(trial.pose);
  }
  for (ScreenedShape& shape : found) {
    const auto k = static_cast<std::size_t>(shape.shape);
    shape.T_shape_scan = distinctInInput(std::move(of_shape[k]), scan, *shapes[k].shape, options.num_poses);
  }
  return found;
}

}  // namespace pcl_symmetry
