#include "pcl_symmetry/symmetry_registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/small_motion.h"
#include "core/base/stopwatch.h"
#include "core/base/symmetric_solvers.h"
#include "core/matching/matching_rules.h"
#include "core/matching/point_pair_index.h"
#include "core/registration/pose_evidence.h"
#include "core/registration/pose_scoring.h"
#include "core/registration/registration_rules.h"
#include "pcl_symmetry/core/rotation_group.h"
#include "registration/pose_refinement.h"
#include "registration/prepared_cloud.h"

namespace pcl_symmetry {

namespace {

/// Two clouds in search frames. The scan is the cloud that was seen from a viewpoint, the model the one that shows its
/// object from all sides: if only the target was seen from one side, the two swap roles.
class CloudPair {
public:
  CloudPair(const PreparedCloud& source, const PreparedCloud& target)
      : swapped_(target.isScan() && !source.isScan()),
        frames_{source.ball().center, target.ball().center, swapped_ ? source.ball().radius : target.ball().radius},
        scan_cloud_(swapped_ ? target : source),
        model_cloud_(swapped_ ? source : target),
        scan_(scan_cloud_.surface(frames_.scale)),
        model_(model_cloud_.surface(frames_.scale)) {}

  const SearchFrames& frames() const { return frames_; }
  const PosedSurface& scan() const { return *scan_; }
  const PosedSurface& model() const { return *model_; }
  std::shared_ptr<const SymmetryFrame> scanFrame() const { return scan_cloud_.frame(frames_.scale); }
  std::shared_ptr<const SymmetryFrame> modelFrame() const { return model_cloud_.frame(frames_.scale); }

  /// T_target_source between input frames as T_model_scan between search frames.
  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const {
    return swappedPose(frames_.toSearch(T_target_source));
  }
  /// T_model_scan between search frames as T_target_source between input frames.
  Eigen::Isometry3d toInput(const Eigen::Isometry3d& T_model_scan) const {
    return frames_.toInput(swappedPose(T_model_scan));
  }
  /// Converts the covariance of motions of the model's search frame to motions of the target's input frame.
  /// \param T_model_scan between search frames, before the motion.
  Matrix6d toInput(const Matrix6d& covariance, const Eigen::Isometry3d& T_model_scan) const {
    // exp(m) T of the model's frame is T^-1 exp(-m) = exp(-Ad(T^-1) m) T^-1 of the scan's; a motion about the
    // center c in units s, x to x + w x (x - c) + s t, is w and s t + c x w about the origin.
    Matrix6d to_target = Matrix6d::Identity();
    if (swapped_) to_target = adjoint(T_model_scan.inverse());
    Matrix6d to_input = Matrix6d::Identity();
    to_input.bottomLeftCorner<3, 3>() = crossMatrix(frames_.target_center);
    to_input.bottomRightCorner<3, 3>() *= frames_.scale;
    const Matrix6d map = to_input * to_target;
    return map * covariance * map.transpose();
  }

  /// Evidence of a pose, in terms of source and target.
  PoseEvidence evidence(const RankedPose& pose) const {
    PoseEvidence evidence = poseEvidence(*scan_, *model_, pose.T_model_scan);
    if (swapped_) {
      std::swap(evidence.overlap_source, evidence.overlap_target);
      evidence.size_ratio = 1.0 / evidence.size_ratio;
    }
    return evidence;
  }

private:
  Eigen::Isometry3d swappedPose(const Eigen::Isometry3d& pose) const { return swapped_ ? pose.inverse() : pose; }

  bool swapped_;
  SearchFrames frames_;
  const PreparedCloud &scan_cloud_, &model_cloud_;
  std::shared_ptr<const PosedSurface> scan_, model_;
};

/// The poses that align the symmetry frames of both clouds. Each is tried with the center of symmetry and with the
/// position that the outline of the scan suggests.
std::vector<Eigen::Isometry3d> posesFromFrames(const CloudPair& clouds) {
  const PoseStarts starts(clouds.scan(), clouds.model());
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& pose : frameHypotheses(*clouds.scanFrame(), *clouds.modelFrame())) {
    poses.push_back(pose);
    poses.push_back(starts.pose(pose.linear()));
  }
  return poses;
}

double angleOf(const Eigen::Isometry3d& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle();
}

/// Rotations to try: the few evenly spread ones that are small enough, and some about each axis.
std::vector<Eigen::Matrix3d> rotationsWithin(double angle, int num_rotations) {
  // Share of the greatest angle. Of 356 tracks of models of PSB (noise of 0.5 %, 40 % missing), 343 are right without
  // rotations about the axes, 347 with this share and 346 with 0.9.
  constexpr double share = 0.6;
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Matrix3d& rotation : uniformRotations(num_rotations))
    if (Eigen::AngleAxisd(rotation).angle() <= angle) rotations.push_back(rotation);
  for (int axis = 0; axis < 3; ++axis)
    for (const double way : {-share, share})
      rotations.push_back(Eigen::AngleAxisd(way * angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix());
  return rotations;
}

/// Poses near a guess to start from: the guess and rotations of it, each also at the position that the outline of the
/// scan suggests.
std::vector<Eigen::Isometry3d> posesAround(const PosedSurface& scan, const PosedSurface& model,
                                           const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options) {
  const PoseStarts starts(scan, model);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Matrix3d& rotation : rotationsWithin(options.around->angle, options.search.num_rotations)) {
    Eigen::Isometry3d pose = guess;
    pose.linear() = rotation * guess.linear();
    poses.push_back(pose);
    poses.push_back(starts.pose(pose.linear()));
  }
  poses.push_back(starts.pose(guess.linear()));
  return poses;
}

/// Poses of two clouds that share a part of their surface, by pairs of points that are alike in both (Drost et al.
/// 2010). A search by the share of the whole surface ends beside them, because parts that the other cloud does not show
/// attract it.
std::vector<RankedPose> posesOfParts(const CloudPair& clouds, const CloudRegistrationOptions& options) {
  const auto& rules = kRegistration;
  PosedSurface scan = clouds.scan(), model = clouds.model();
  scan.seen = model.seen = std::nullopt;  // for the fit, because missing parts look like free space
  const PointPairIndex pairs({evenSurfacePoints(model.points, kMatching.num_pair_points, options.seed)},
                             options.num_threads);
  const SurfacePoints few = evenSurfacePoints(scan.points, kMatching.num_scan_points, options.seed);
  const PoseScorer scorer(scan, model);
  std::vector<RankedPose> poses;
  const std::vector<ShapeOfPairs> found = pairs.nearest(few, {1, rules.num_part_poses, options.num_threads});
  for (const Eigen::Isometry3d& pose : found.front().T_shape_scan) {
    poses.push_back({pose, {}});
    poses.back().improve(scorer, {rules.part_steps, rules.fine_points, rules.part_width, rules.fine_width});
    poses.back().score = {};  // all of these poses are refined
  }
  if (poses.empty()) return poses;
  poses = refinePoses(scan, model, poses, options);
  for (RankedPose& pose : poses) pose.score = lastScore(clouds.scan(), clouds.model(), pose.T_model_scan);
  return poses;
}

/// A pose with its evidence.
struct JudgedPose {
  RankedPose pose;
  PoseEvidence evidence;
  double confidence;

  double odds() const { return confidence / (1.0 - confidence); }
};

/// Poses with their evidence, by decreasing confidence.
/// \param poses distinct poses, best first.
/// \param within greatest deficit in merit to the first pose; poses with more are left out.
std::vector<JudgedPose> judgedPoses(const CloudPair& clouds, const std::vector<RankedPose>& poses, double within) {
  std::vector<JudgedPose> judged;
  for (const RankedPose& pose : poses) {
    if (pose.score.merit() < poses.front().score.merit() - within) continue;
    const PoseEvidence evidence = clouds.evidence(pose);
    judged.push_back({pose, evidence, poseConfidence(evidence)});
  }
  sortDescending(judged, &JudgedPose::confidence);
  return judged;
}

/// \return whether two poses count as one: they differ by a symmetry of the model, or by a motion that contradicts
/// neither scan, up to the remaining errors of ICP.
bool differBySymmetry(const CloudPair& clouds, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& other,
                      const CloudRegistrationOptions& options) {
  const PosedSurface& model = clouds.model();
  const Eigen::Isometry3d motion = other * pose.inverse();
  if (model.seen)
    return mayBeSymmetry(motion, model) &&
           (!clouds.scan().seen || mayBeSymmetry(pose.inverse() * other, clouds.scan()));
  if (!isSymmetry(motion, model, kRegistration.near_pose)) return false;
  if (isSymmetry(motion, model, kRegistration.same_pose)) return true;
  const RankedPose nearest = refinePoses(model, model, {{motion, {}}}, options).front();
  return isSymmetry(nearest.T_model_scan, model, kRegistration.same_pose);
}

/// \return whether a pose beside the best one is as likely: the fit of the bodies changes its odds, and no part that the
/// best pose brings together, such as a handle, lies aside.
bool fitsBeside(const JudgedPose& pose, const JudgedPose& best) {
  return pose.odds() > kRegistration.beside_odds * best.odds() &&
         pose.evidence.aside < best.evidence.aside + kRegistration.beside_aside;
}

/// See PoseEvidence::uniqueness.
/// \param judged poses from the search that the best one is compared with, among which it may be.
/// \param beside poses beside the best one, as for fitsBeside().
double uniquenessOf(const CloudPair& clouds, const JudgedPose& best, const std::vector<JudgedPose>& judged,
                    const std::vector<JudgedPose>& beside, const CloudRegistrationOptions& options) {
  const auto isOther = [&](const JudgedPose& pose) {
    return !differBySymmetry(clouds, best.pose.T_model_scan, pose.pose.T_model_scan, options);
  };
  double all = best.odds();
  for (const JudgedPose& other : judged)
    if (isOther(other)) all += other.odds() > kRegistration.like_odds * best.odds() ? best.odds() : other.odds();
  for (const JudgedPose& other : beside)
    if (fitsBeside(other, best) && isOther(other)) all += best.odds();
  return best.odds() / all;
}

/// Covariance of the motion of the model that takes a pose to the true one, in search units.
Matrix6d searchCovariance(const CloudPair& clouds, const RankedPose& pose, const CloudRegistrationOptions& inner) {
  const double reach = closestReach(clouds.scan(), clouds.model(), inner.max_correspondence);
  return poseCovariance(clouds.scan(), clouds.model(), pose.T_model_scan, std::max(1, pose.num_points), reach);
}

/// A motion that changes how two aligned surfaces fit less than others do: a rotation about an axis, a translation
/// along a direction, or both.
struct LooseMotion {
  std::optional<Eigen::ParametrizedLine<double, 3>> axis;
  std::optional<Eigen::Vector3d> direction;
};

/// The two least constrained motions of the model at a pose. Each may mix a rotation with a translation along its axis,
/// because the wall of a can admits both.
std::vector<LooseMotion> looseMotions(const CloudPair& clouds, const RankedPose& pose,
                                      const CloudRegistrationOptions& inner) {
  constexpr double some = 0.1;  // share of a motion
  const SymmetricEigen<Matrix6d> motions(searchCovariance(clouds, pose, inner));
  std::vector<LooseMotion> loose;
  for (const int k : {5, 4}) {
    const Eigen::Vector3d rotation = motions.eigenvectors().col(k).head<3>(),
                          translation = motions.eigenvectors().col(k).tail<3>(), axis = rotation.normalized();
    const bool rotates = rotation.norm() > some;
    const Eigen::Vector3d along = rotates ? Eigen::Vector3d(axis * axis.dot(translation)) : translation;
    loose.emplace_back();
    if (rotates) loose.back().axis = {rotation.cross(translation) / rotation.squaredNorm(), axis};
    if (along.norm() > some) loose.back().direction = along.normalized();
  }
  return loose;
}

/// Refined poses beside a pose that the surfaces hardly distinguish from it, such as rotations about the axis of a can
/// whose handle one of the scans does not show.
std::vector<RankedPose> slidPoses(const CloudPair& clouds, const RankedPose& pose,
                                  const CloudRegistrationOptions& inner) {
  std::vector<Eigen::Isometry3d> starts;
  for (const LooseMotion& motion : looseMotions(clouds, pose, inner))
    for (const double way : {-kRegistration.slide, kRegistration.slide}) {
      if (motion.axis) starts.push_back(motionAbout(*motion.axis, way) * pose.T_model_scan);
      if (motion.direction)
        starts.push_back(isometry(Eigen::Matrix3d::Identity(), way * *motion.direction) * pose.T_model_scan);
    }
  std::vector<RankedPose> poses = closestPoses(clouds.scan(), clouds.model(), starts, inner);
  poses.insert(poses.begin(), pose);
  poses = firstDistinct(poses, poses.size());
  poses.erase(poses.begin());
  return poses;
}

/// Poses rotated about the axis of the model that fit about as well as a given one, if that pose still agrees when it
/// is rotated a little: the search finds the axis of a mug, but not always where its handle is.
std::vector<JudgedPose> rotatedPoses(const CloudPair& clouds, const JudgedPose& best,
                                     const CloudRegistrationOptions& inner) {
  std::vector<JudgedPose> fitting;
  const auto agrees = [](const PoseEvidence& evidence) {
    return evidence.agreement > kRegistration.symmetric_agreement;
  };
  if (!agrees(best.evidence)) return fitting;
  std::vector<Eigen::Isometry3d> starts;
  for (const LooseMotion& motion : looseMotions(clouds, best.pose, inner)) {
    if (!motion.axis) continue;
    const auto rotated = [&](double angle) { return motionAbout(*motion.axis, angle) * best.pose.T_model_scan; };
    const Eigen::Isometry3d beside = rotated(kRegistration.slide);
    if (!agrees(clouds.evidence({beside, {}})) || differBySymmetry(clouds, best.pose.T_model_scan, beside, inner))
      continue;
    for (double angle = kRegistration.slide; angle < 2.0 * kPi - 0.5 * kRegistration.slide;
         angle += kRegistration.slide)
      starts.push_back(rotated(angle));
  }
  const std::vector<RankedPose> poses =
      firstDistinct(closestPoses(clouds.scan(), clouds.model(), starts, inner), starts.size());
  for (JudgedPose& rotated : judgedPoses(clouds, poses, std::numeric_limits<double>::infinity())) {
    if (!fitsBeside(rotated, best)) continue;
    rotated.pose.score = lastScore(clouds.scan(), clouds.model(), rotated.pose.T_model_scan);
    fitting.push_back(std::move(rotated));
  }
  return fitting;
}

/// Removes the poses that are not around a guess.
/// \param poses poses between search frames.
void keepAround(const CloudPair& clouds, const Eigen::Isometry3d& guess, const PoseNeighborhood& around,
                std::vector<RankedPose>& poses) {
  const Eigen::Vector3d& center = clouds.frames().source_center;
  const auto isFar = [&](const RankedPose& pose) {
    const Eigen::Isometry3d T_target_source = clouds.toInput(pose.T_model_scan);
    return angleOf(T_target_source * guess.inverse()) > around.angle ||
           (T_target_source * center - guess * center).norm() > around.distance;
  };
  eraseIf(poses, isFar);
}

/// The options with the number of threads of the search and with lengths in units of the search.
CloudRegistrationOptions inSearchUnits(CloudRegistrationOptions options, double scale) {
  options.search.num_threads = options.num_threads;
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

std::string CloudRegistration::doubt(double min_confidence) const {
  const bool fits = evidence.uniqueness < 1.0 && confidence >= min_confidence * evidence.uniqueness;
  std::ostringstream reason;
  reason << (fits ? "another pose fits as well" : "nothing fits") << (is_around_guess ? " around the guess" : "")
         << ": in the best pose, with a confidence of " << std::round(100.0 * confidence) / 100.0 << ", "
         << (covariance ? doubtOf(evidence) : "no pose is left");
  return reason.str();
}

std::shared_ptr<const PreparedCloud> registrationTarget(const Points& points, const std::optional<Visibility>& seen,
                                                        const CloudRegistrationOptions& options) {
  options.validate();
  return std::make_shared<const PreparedCloud>("target", points, seen, options);
}

CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options) {
  return registerClouds(source, source_seen, *registrationTarget(target, target_seen, options), guess, options);
}

CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const PreparedCloud& target, const Eigen::Isometry3d& guess,
                                 const CloudRegistrationOptions& options) {
  options.validate();
  CloudRegistration result;
  result.is_around_guess = options.around.has_value();
  StageTimes done(result.timing_ms);

  const PreparedCloud prepared_source("source", source, source_seen, options);
  if (std::min(source.cols(), target.size()) < kLeastRegistrationPoints) {
    result.poses.push_back({guess, {}});
    result.T_target_source = guess;
    return result;
  }
  const CloudPair clouds(prepared_source, target);
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
  } else {
    add(posesFromFrames(clouds));
    done("frames");
  }
  std::vector<RankedPose> poses = searchPoses(clouds.scan(), clouds.model(), hypotheses, search);
  if (options.around) keepAround(clouds, guess, *options.around, poses);
  done("search");
  if (!poses.empty()) poses = refinePoses(clouds.scan(), clouds.model(), poses, inner);
  if (options.around) keepAround(clouds, guess, *options.around, poses);
  done("refine");
  std::vector<JudgedPose> judged = judgedPoses(clouds, poses, kRegistration.like_merit);
  if (options.search_parts && !options.around && !poses.empty() &&
      judged.front().confidence < kRegistration.min_confidence) {
    const std::vector<RankedPose> of_parts = posesOfParts(clouds, inner);
    poses.insert(poses.end(), of_parts.begin(), of_parts.end());
    poses = distinctPoses(std::move(poses));
    judged = judgedPoses(clouds, poses, std::numeric_limits<double>::infinity());
    done("parts");
  }
  if (!judged.empty()) {
    const std::vector<JudgedPose> likeliest = judged;
    std::vector<JudgedPose> beside;  // in tracks, the guess decides
    if (!options.around) beside = rotatedPoses(clouds, judged.front(), inner);
    append(judged, beside);
    sortDescending(judged, &JudgedPose::confidence);
    result.evidence = judged.front().evidence;
    if (judged.front().confidence >= kRegistration.min_confidence) {
      // Between two scans, the merit grows with the surface that they share: a pose of less merit may fit equally well.
      constexpr double any = std::numeric_limits<double>::infinity();
      const std::vector<JudgedPose> all = clouds.model().seen ? judgedPoses(clouds, poses, any) : likeliest;
      if (!options.around) append(beside, judgedPoses(clouds, slidPoses(clouds, judged.front().pose, inner), any));
      result.evidence.uniqueness = uniquenessOf(clouds, judged.front(), all, beside, inner);
    }
    result.confidence = poseConfidence(result.evidence);
    std::vector<RankedPose> ranked;
    for (const JudgedPose& one : judged) ranked.push_back(one.pose);
    if (inner.refine_closely) ranked.front() = closestPose(clouds.scan(), clouds.model(), ranked.front(), inner);
    ranked.insert(ranked.end(), poses.begin(), poses.end());
    for (const RankedPose& pose : firstDistinct(ranked, static_cast<std::size_t>(search.max_poses)))
      result.poses.push_back({clouds.toInput(pose.T_model_scan), pose.score});
    result.covariance = clouds.toInput(searchCovariance(clouds, ranked.front(), inner), ranked.front().T_model_scan);
  }
  if (result.poses.empty()) result.poses.push_back({guess, {}});
  static_cast<RegisteredPose&>(result) = result.poses.front();
  return result;
}

}  // namespace pcl_symmetry
