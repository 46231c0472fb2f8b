#include "pcl_symmetry/registration/symmetry_registration.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/stopwatch.h"
#include "core/registration/frame_hypotheses.h"
#include "core/registration/pose_starts.h"
#include "core/registration/ranked_poses.h"
#include "registration/pose_refinement.h"

namespace pcl_symmetry {

namespace {

/// The least number of points that fix a pose. derived: three points fix a rotation.
constexpr Eigen::Index kLeastPoints = 3;

BoundingBall ballOf(const char* name, const Points& points) {
  const BoundingBall ball = boundingBall(points);
  if (points.cols() < kLeastPoints || !(ball.radius > 0.0))
    throw std::invalid_argument(std::string(name) + ": no extent, must have three different finite points");
  return ball;
}

/// Two clouds in search frames. The scan is the one that was seen from a viewpoint, the model the one that shows its
/// object from all sides: where only the target was seen from one side, the two change places.
class CloudPair {
public:
  CloudPair(const Points& source, const std::optional<Visibility>& source_seen, const Points& target,
            const std::optional<Visibility>& target_seen, const CloudRegistrationOptions& options)
      : swapped_(target_seen && !source_seen),
        frames_(framesOf(source, target, swapped_)),
        source_(surfaceOf(source, frames_.source_center, source_seen, options)),
        target_(surfaceOf(target, frames_.target_center, target_seen, options)) {}

  const SearchFrames& frames() const { return frames_; }
  const PosedSurface& scan() const { return swapped_ ? target_ : source_; }
  const PosedSurface& model() const { return swapped_ ? source_ : target_; }

  /// T_target_source between input frames as T_model_scan between search frames.
  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const {
    return swappedPose(frames_.toSearch(T_target_source));
  }
  /// T_model_scan between search frames as T_target_source between input frames.
  Eigen::Isometry3d toInput(const Eigen::Isometry3d& T_model_scan) const {
    return frames_.toInput(swappedPose(T_model_scan));
  }

private:
  static SearchFrames framesOf(const Points& source, const Points& target, bool swapped) {
    const BoundingBall source_ball = ballOf("source", source), target_ball = ballOf("target", target);
    return {source_ball.center, target_ball.center, swapped ? source_ball.radius : target_ball.radius};
  }

  PosedSurface surfaceOf(const Points& points, const Eigen::Vector3d& center, const std::optional<Visibility>& seen,
                         const CloudRegistrationOptions& options) const {
    return {normalizePoints(points, center, frames_.scale),
            seen ? std::optional(seen->normalized(center, frames_.scale)) : std::nullopt, options.seed,
            options.num_threads};
  }

  Eigen::Isometry3d swappedPose(const Eigen::Isometry3d& pose) const { return swapped_ ? pose.inverse() : pose; }

  bool swapped_;
  SearchFrames frames_;
  PosedSurface source_, target_;
};

/// The poses that bring the symmetry frames of both clouds together. Each is tried with the center of symmetry that was
/// found, and with the place that the outline of the scan suggests.
std::vector<Eigen::Isometry3d> posesFromFrames(const PosedSurface& scan, const PosedSurface& model,
                                               const FrameOptions& options) {
  const auto frameOf = [&](const PosedSurface& surface) {
    return symmetryFrame(surface.points, options, surface.seen ? &*surface.seen : nullptr);
  };
  const PoseStarts starts(scan, model);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& pose : frameHypotheses(frameOf(scan), frameOf(model))) {
    poses.push_back(pose);
    poses.push_back(starts.pose(pose.linear()));
  }
  return poses;
}

double angleOf(const Eigen::Isometry3d& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle();
}

/// Poses near a guess to start from: the guess and turns of it, each also where the outline of the scan suggests.
std::vector<Eigen::Isometry3d> posesAround(const PosedSurface& scan, const PosedSurface& model,
                                           const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options) {
  const PoseStarts starts(scan, model);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Matrix3d& turn : uniformRotations(options.search.num_rotations)) {
    if (Eigen::AngleAxisd(turn).angle() > options.around->angle) continue;
    Eigen::Isometry3d pose = guess;
    pose.linear() = turn * guess.linear();
    poses.push_back(pose);
    poses.push_back(starts.pose(pose.linear()));
  }
  poses.push_back(starts.pose(guess.linear()));
  return poses;
}

/// Leaves those of the poses that are around a guess.
/// \param poses between search frames.
void keepAround(const CloudPair& clouds, const Eigen::Isometry3d& guess, const PoseNeighbourhood& around,
                std::vector<RankedPose>& poses) {
  const Eigen::Vector3d& center = clouds.frames().source_center;
  const auto isFar = [&](const RankedPose& pose) {
    const Eigen::Isometry3d T_target_source = clouds.toInput(pose.T_model_scan);
    return angleOf(T_target_source * guess.inverse()) > around.angle ||
           (T_target_source * center - guess * center).norm() > around.distance;
  };
  poses.erase(std::remove_if(poses.begin(), poses.end(), isFar), poses.end());
}

/// The options with threads and seed passed on to all parts, and lengths in units of the search.
CloudRegistrationOptions inSearchUnits(CloudRegistrationOptions options, double scale) {
  options.search.num_threads = options.frame.num_threads = options.frame.edt.num_threads = options.num_threads;
  options.frame.seed = options.seed;
  if (options.max_correspondence) *options.max_correspondence /= scale;
  return options;
}

}  // namespace

void CloudRegistrationOptions::validate() const {
  frame.validate();
  search.validate();
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  if (around) {
    check(around->angle > 0.0 && around->angle <= kPi, "around.angle", around->angle, "in (0, pi]");
    check(around->distance >= 0.0, "around.distance", around->distance, ">= 0");
  }
  if (max_correspondence) check(*max_correspondence > 0.0, "max_correspondence", *max_correspondence, "> 0");
  check(transformation_epsilon >= 0.0, "transformation_epsilon", transformation_epsilon, ">= 0");
  checkNumThreads(num_threads);
}

CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options) {
  options.validate();
  CloudRegistration result;
  Stopwatch watch;
  const auto done = [&](const char* stage) { result.timing_ms.emplace_back(stage, watch.lap()); };

  const CloudPair clouds(source, source_seen, target, target_seen, options);
  const CloudRegistrationOptions inner = inSearchUnits(options, clouds.frames().scale);
  done("prepare");

  std::vector<Eigen::Isometry3d> hypotheses{clouds.toSearch(guess)};
  const auto add = [&](const std::vector<Eigen::Isometry3d>& poses) {
    hypotheses.insert(hypotheses.end(), poses.begin(), poses.end());
  };
  PoseSearchOptions search = inner.search;
  if (options.around) {
    add(posesAround(clouds.scan(), clouds.model(), hypotheses.front(), inner));
    search.num_rotations = 0;
  } else if (options.frames) {
    add(posesFromFrames(clouds.scan(), clouds.model(), inner.frame));
    done("frames");
  }
  std::vector<RankedPose> poses = searchPoses(clouds.scan(), clouds.model(), hypotheses, search);
  if (options.around) keepAround(clouds, guess, *options.around, poses);
  done("search");
  if (!poses.empty()) poses = refinePoses(clouds.scan(), clouds.model(), poses, inner);
  if (options.around) keepAround(clouds, guess, *options.around, poses);
  done("refine");
  for (const RankedPose& pose : poses) result.poses.push_back({clouds.toInput(pose.T_model_scan), pose.score});
  if (poses.empty()) result.poses.push_back({guess, {}});
  static_cast<RegisteredPose&>(result) = result.poses.front();
  return result;
}

}  // namespace pcl_symmetry
