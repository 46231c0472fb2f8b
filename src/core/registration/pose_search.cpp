#include "core/registration/pose_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace pcl_symmetry {

namespace {

constexpr int kScreenPoints = 80, kCoarsePoints = 120, kFinePoints = 400;
constexpr int kCoarseSteps = 10, kFineSteps = 10;
constexpr int kOutlinePoints = 200;
constexpr double kScreenWidth = 0.2;  // radii: coarse starts are this far off

/// Points by which both clouds are held together along three directions of the scanner: the middle of the outline
/// twice, and the front.
Eigen::Vector3d outline(const Eigen::Matrix3Xd& in_scanner) {
  const Eigen::Vector3d low = in_scanner.rowwise().minCoeff(), high = in_scanner.rowwise().maxCoeff();
  return {0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z()};
}

Eigen::Matrix3Xd sampleOf(const PosedSurface& surface) {
  const auto size = std::min<Eigen::Index>(kOutlinePoints, surface.points.cols());
  Eigen::Matrix3Xd sample(3, size);
  for (Eigen::Index i = 0; i < size; ++i) sample.col(i) = surface.points.col(surface.order[i]).cast<double>();
  return sample;
}

/// What poseFromRotation() knows before it knows the rotation.
class PoseStart {
public:
  PoseStart(const PosedSurface& scan, const PosedSurface& model)
      : from_outline_(scan.seen.has_value()), model_(sampleOf(model)) {
    if (!from_outline_) {
      scan_anchor_ = centerOfMass(scan.points);
      model_anchor_ = centerOfMass(model.points);
      return;
    }
    const Eigen::Vector3d forward = (centerOfMass(scan.points) - scan.seen->viewpoint()).normalized();
    R_scanner_scan_.row(2) = forward;
    R_scanner_scan_.row(0) = forward.unitOrthogonal();
    R_scanner_scan_.row(1) = forward.cross(R_scanner_scan_.row(0).transpose());
    scan_anchor_ = R_scanner_scan_.transpose() * outline(R_scanner_scan_ * scan.points.cast<double>());
  }

  Eigen::Isometry3d pose(const Eigen::Matrix3d& R_model_scan) const {
    Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
    T_model_scan.linear() = R_model_scan;
    Eigen::Vector3d anchor = model_anchor_;
    if (from_outline_) {
      const Eigen::Matrix3d R_scanner_model = R_scanner_scan_ * R_model_scan.transpose();
      anchor = R_scanner_model.transpose() * outline(R_scanner_model * model_);
    }
    T_model_scan.translation() = anchor - R_model_scan * scan_anchor_;
    return T_model_scan;
  }

private:
  bool from_outline_;
  Eigen::Matrix3Xd model_;
  Eigen::Matrix3d R_scanner_scan_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scan_anchor_, model_anchor_ = Eigen::Vector3d::Zero();
};

bool better(const RankedPose& a, const RankedPose& b) {
  return a.score.merit() > b.score.merit();
}

/// The first \p most poses that differ from all before them.
std::vector<RankedPose> distinct(std::vector<RankedPose> poses, std::size_t most, const PoseSearchOptions& options) {
  std::stable_sort(poses.begin(), poses.end(), better);
  std::vector<RankedPose> kept;
  for (const RankedPose& pose : poses) {
    const auto same = [&](const RankedPose& other) {
      const Eigen::Isometry3d motion = other.T_model_scan * pose.T_model_scan.inverse();
      return Eigen::AngleAxisd(motion.linear()).angle() < options.merge_angle &&
             motion.translation().norm() < options.merge_distance;
    };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(pose);
    if (kept.size() == most) break;
  }
  return kept;
}

}  // namespace

void PoseSearchOptions::validate() const {
  check(num_rotations >= 0, "num_rotations", num_rotations, ">= 0");
  check(num_screened >= 1, "num_screened", num_screened, ">= 1");
  check(num_refined >= 1, "num_refined", num_refined, ">= 1");
  check(max_poses >= 1, "max_poses", max_poses, ">= 1");
  check(coarse_width > 0.0, "coarse_width", coarse_width, "> 0");
  check(fine_width > 0.0, "fine_width", fine_width, "> 0");
  check(merge_angle >= 0.0, "merge_angle", merge_angle, ">= 0");
  check(merge_distance >= 0.0, "merge_distance", merge_distance, ">= 0");
  checkNumThreads(num_threads);
}

std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations) {
  constexpr double kPsi = 1.533751168755204288118041;
  std::vector<Eigen::Matrix3d> rotations;
  for (int i = 0; i < num_rotations; ++i) {
    const double s = i + 0.5, share = s / num_rotations;
    const double a = 2.0 * M_PI * s / std::sqrt(2.0), b = 2.0 * M_PI * s / kPsi;
    const double inner = std::sqrt(share), outer = std::sqrt(1.0 - share);
    rotations.push_back(
        Eigen::Quaterniond(outer * std::cos(b), inner * std::sin(a), inner * std::cos(a), outer * std::sin(b))
            .toRotationMatrix());
  }
  return rotations;
}

Eigen::Isometry3d poseFromRotation(const Eigen::Matrix3d& R_model_scan, const PosedSurface& scan,
                                   const PosedSurface& model) {
  return PoseStart(scan, model).pose(R_model_scan);
}

std::vector<RankedPose> searchPoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<Eigen::Isometry3d>& hypotheses,
                                    const PoseSearchOptions& options) {
  options.validate();
  constexpr std::size_t kBlockSize = 16;
  const PoseScorer scorer(scan, model);
  const auto forEach = [&](std::vector<RankedPose>& poses, const auto& improve) {
    parallelRanges(poses.size(), kBlockSize, options.num_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) improve(poses[i]);
    });
  };
  const auto improveAll = [&](std::vector<RankedPose>& poses, int num_steps, int num_points, double from, double to) {
    forEach(poses, [&](RankedPose& pose) {
      for (int i = 0; i < num_steps; ++i) {
        const double width = from * std::pow(to / from, static_cast<double>(i) / (num_steps - 1));
        pose.T_model_scan = scorer.step(pose.T_model_scan, {num_points, width});
      }
      pose.score = scorer.score(pose.T_model_scan, {num_points, to});
    });
  };

  const PoseStart start(scan, model);
  const std::vector<Eigen::Matrix3d> rotations = uniformRotations(options.num_rotations);
  std::vector<RankedPose> screened(rotations.size());
  parallelRanges(rotations.size(), kBlockSize, options.num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      screened[i].T_model_scan = start.pose(rotations[i]);
      screened[i].score = scorer.score(screened[i].T_model_scan, {kScreenPoints, kScreenWidth});
    }
  });
  std::stable_sort(screened.begin(), screened.end(), better);
  screened.resize(std::min<std::size_t>(screened.size(), options.num_screened));
  for (const Eigen::Isometry3d& hypothesis : hypotheses) screened.push_back({hypothesis, {}});

  const double middle = std::sqrt(options.coarse_width * options.fine_width);
  improveAll(screened, kCoarseSteps, kCoarsePoints, options.coarse_width, middle);
  std::vector<RankedPose> refined = distinct(std::move(screened), options.num_refined, options);
  improveAll(refined, kFineSteps, kFinePoints, middle, options.fine_width);
  return distinct(std::move(refined), options.max_poses, options);
}

}  // namespace pcl_symmetry
