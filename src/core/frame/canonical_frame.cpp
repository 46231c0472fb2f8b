#include "core/frame/canonical_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/constants.h"
#include "core/base/small_motion.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// Makes axes exactly orthonormal and right-handed.
Eigen::Matrix3d orthonormal(const Eigen::Matrix3f& axes) {
  Eigen::Matrix3d result = axes.cast<double>();
  result.col(0).normalize();
  result.col(1) = (result.col(1) - result.col(0).dot(result.col(1)) * result.col(0)).normalized();
  result.col(2) = result.col(0).cross(result.col(1));
  return result;
}

/// The mean of offsets, weighted by score and by closeness to a middle.
float meanOffset(const FrameEvidence& evidence, const std::vector<float>& scores, double middle) {
  const float top = *std::max_element(scores.begin(), scores.end());
  double sum = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double r = static_cast<double>(i) - std::floor(evidence.reach);
    const double away = (r - middle) / (kFrame.offset_width * evidence.reach);
    const double weight =  // falls slowly, so that a distant peak keeps its position
        std::exp(kFrame.offset_sharpness * (scores[i] - top)) * std::pow(1.0 + away * away, -1.5);
    sum += weight;
    moment += weight * r;
  }
  return static_cast<float>(moment / sum);
}

/// The maximum of D near an offset, by parabolas. D is the mean of f over the images of FrameEvidence::center_samples
/// and, unlike profiles, has no steps of a cell.
ScoredOffset peakNear(const FrameEvidence& evidence, const Eigen::Vector3d& axis, double offset) {
  const Eigen::Array3d corner = Eigen::Array3d::Constant(-middleCell(evidence.edt));
  const Eigen::Matrix3Xd& samples = evidence.center_samples;
  const Eigen::RowVectorXd heights = axis.transpose() * (samples.colwise() + corner.matrix());
  const auto sum = [&](double r, double way) {
    double f = 0.0;
    for (Eigen::Index i = 0; i < samples.cols(); ++i)
      f += evidence.edt.atCell(samples.col(i) + way * (r - heights[i]) * axis);
    return f;
  };
  double top = 0.0;
  for (const double step : {1.0, 0.5}) {
    const double below = sum(offset - step, 2.0), above = sum(offset + step, 2.0);
    top = sum(offset, 2.0);
    const double bend = below - 2.0 * top + above;
    if (!(bend < 0.0)) continue;
    const double way = std::clamp(0.5 * (below - above) / bend, -1.0, 1.0);
    offset += step * way;
    top += 0.5 * way * (above - below + way * bend);
  }
  return {static_cast<float>(offset), static_cast<float>(top / sum(offset, 0.0))};
}

/// Offset at which the plane of a normal passes through the center of symmetry.
float centralOffset(const FrameEvidence& evidence, const Eigen::Vector3f& axis, const CellPlane* completed_across) {
  const std::vector<float> s = evidence.profile(axis, completed_across);
  const float of_flat = meanOffset(evidence, s, evidence.middleAlong(axis));
  if (evidence.scanned) return of_flat;
  const auto at = std::max_element(s.begin(), s.end()) - s.begin();
  const auto side = static_cast<std::ptrdiff_t>(kFrame.clear_side * evidence.reach);
  float beside = 0.0f;  // the greatest score outside the peak
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(s.size()); ++i)
    if (std::abs(i - at) > side) beside = std::max(beside, s[i]);
  const auto trustIn = [&](const ScoredOffset& peak) {
    const double away = std::abs(peak.offset - of_flat) / (kFrame.offset_width * evidence.reach);
    const double height = peak.score - beside - kFrame.clear_height * std::min(away, 1.0);
    return static_cast<float>(std::clamp(height / kFrame.clear_ramp, 0.0, 1.0));
  };
  const float offset = static_cast<float>(at) - std::floor(evidence.reach);
  if (trustIn({offset, s[at] + kFrame.lost_height}) == 0.0f) return of_flat;
  const ScoredOffset peak = peakNear(evidence, axis.cast<double>(), offset);
  const float trust = trustIn(peak);
  return trust * peak.offset + (1.0f - trust) * of_flat;
}

}  // namespace

Eigen::Matrix3d principalSymmetryAxes(const PointsRef& points, const Eigen::Matrix3f& axes) {
  Eigen::Matrix3d result = orthonormal(axes);
  const Eigen::Vector3d mean = centerOfMass(points);
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    moments.array() += (result.transpose() * (points.col(i).cast<double>() - mean)).array().cube();
  for (int k = 1; k < 3; ++k)
    if (moments[k] < 0.0) result.col(k) *= -1.0;
  result.col(0) = result.col(1).cross(result.col(2));
  return result;
}

Eigen::Vector3d centerOfSymmetry(const FrameEvidence& evidence, const FrameCandidate& frame) {
  const CellPlane first{frame.axes.col(0), frame.offsets[0]};
  Eigen::Vector3f offsets;
  for (int k = 0; k < 3; ++k)
    offsets[k] = centralOffset(evidence, frame.axes.col(k), k > 0 ? evidence.completedAcross(first) : nullptr);
  return evidence.toInput(frame.axes * offsets);
}

Eigen::Vector3d meanCenter(const std::vector<Eigen::Vector3d>& centers, const std::vector<FrameCandidate>& frames) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double weight = std::exp(kFrame.center_sharpness * std::min(frames[i].value - frames.front().value, 0.0));
    mean += weight * (centers[i] - centers.front());
    sum += weight;
  }
  return centers.front() + mean / sum;
}

int revolutionAxis(const FrameEvidence& evidence, const FrameCandidate& frame) {
  const Eigen::Vector3f center = frame.axes * frame.offsets;
  int axis = -1, count = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f u = frame.axes.col((k + 1) % 3), v = frame.axes.col((k + 2) % 3);
    float lowest = std::numeric_limits<float>::infinity(), highest = 0.0f;
    for (int a = 0; a < kFrame.num_revolution_angles; ++a) {
      const float angle = static_cast<float>(kPi * a / kFrame.num_revolution_angles);
      const Eigen::Vector3f normal = std::cos(angle) * u + std::sin(angle) * v;
      const float score = evidence.nearbyOffset(normal, normal.dot(center)).score;
      lowest = std::min(lowest, score);
      highest = std::max(highest, score);
    }
    if (lowest < highest - kFrame.tie) continue;
    axis = k;
    ++count;
  }
  return count >= 2 ? 3 : axis;
}

Eigen::Isometry3d canonicalPose(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center) {
  return isometry(axes.transpose(), -axes.transpose() * center);
}

void addWithSigns(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center, std::vector<Eigen::Isometry3d>& poses) {
  for (int kept = -1; kept < 3; ++kept) {
    Eigen::Vector3d signs = Eigen::Vector3d::Constant(kept < 0 ? 1.0 : -1.0);
    if (kept >= 0) signs[kept] = 1.0;
    const Eigen::Isometry3d T = canonicalPose(axes * signs.asDiagonal(), center);
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(T.linear() * other.linear().transpose()).angle() < kFrame.same_frame;
    });
    if (!known) poses.push_back(T);
  }
}

void addTied(const FrameCandidate& frame, const Eigen::Vector3f& scores, const Eigen::Vector3d& center,
             std::vector<Eigen::Isometry3d>& poses) {
  std::array<int, 3> order{0, 1, 2};
  do {
    bool tied = true;
    Eigen::Matrix3f axes;
    for (int k = 0; k < 3; ++k) {
      tied &= frame.scores[order[k]] >= scores[k] - kFrame.tie;
      axes.col(k) = frame.axes.col(order[k]);
    }
    if (tied) addWithSigns(orthonormal(axes), center, poses);
  } while (std::next_permutation(order.begin(), order.end()));
}

bool isRotatedAboutRevolution(const Eigen::Matrix3f& axes, int revolution_axis, const Eigen::Matrix3f& frame) {
  if (revolution_axis < 0) return false;
  if (revolution_axis == 3) return true;
  const Eigen::Vector3f axis = axes.col(revolution_axis);
  return (frame.transpose() * axis).cwiseAbs().maxCoeff() > std::cos(kFrame.same_frame);
}

}  // namespace pcl_symmetry
