#include "core/matching/point_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

// Added to divisors.
constexpr float kTiny = 1e-20f;

int angleStep(double cosine, int num_steps, double range) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::min(num_steps - 1, static_cast<int>(angle / range * num_steps));
}

/// Where a step of the angle ends, as cosines.
template <int kSteps>
std::vector<float> cosineLimits(double range) {
  std::vector<float> limits;
  for (int k = 1; k < kSteps; ++k) limits.push_back(static_cast<float>(std::cos(range * k / kSteps)));
  return limits;
}

/// How many of the limits each value has come down to.
Eigen::ArrayXi limitsReached(const Eigen::ArrayXf& values, const std::vector<float>& limits) {
  Eigen::ArrayXi count = Eigen::ArrayXi::Zero(values.size());
  for (const float limit : limits) count += (values <= limit).cast<int>();
  return count;
}

/// Angles of directions in a plane, of 256 steps.
Eigen::ArrayXi anglesOf(const Eigen::ArrayXf& u, const Eigen::ArrayXf& v) {
  const Eigen::ArrayXf au = u.abs(), av = v.abs(), t = au.min(av) / (au.max(av) + kTiny), s = t * t;
  // Abramowitz and Stegun 4.4.47, off by 1e-5, over 2 pi.
  Eigen::ArrayXf angle = t * (0.159133f + s * (-0.0525688f + s * (0.0286703f + s * (-0.0135493f + s * 0.00331601f))));
  angle = (au < av).select(0.25f - angle, angle);
  angle = (u < 0.0f).select(0.5f - angle, angle);
  angle = (v < 0.0f).select(1.0f - angle, angle);
  return (256.0f * angle).unaryExpr([](float step) { return static_cast<int>(step) & 255; }).cast<int>();
}

}  // namespace

Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

PointPair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                 const Eigen::Vector3d& second_normal) {
  const Eigen::Vector3d line = second - first;
  const double distance = line.norm();
  const Eigen::Vector3d direction = frame.transpose() * line / distance;
  PointPair pair;
  pair.log_distance = std::log(distance) / kPairDistanceStep;
  pair.angle = std::acos(std::clamp(direction.x(), -1.0, 1.0)) / kPi * kPairAngles;
  pair.other_angle = angleStep(std::abs(second_normal.dot(line)) / distance, kPairOtherAngles, 0.5 * kPi);
  pair.between = angleStep(std::abs(second_normal.dot(frame.col(0))), kPairOtherAngles, 0.5 * kPi);
  const double rotation = std::atan2(direction.z(), direction.y()) / (2.0 * kPi);
  pair.rotation = static_cast<std::uint8_t>(static_cast<int>(std::floor((rotation + 1.0) * 256.0)) & 255);
  return pair;
}

PairedSurface::PairedSurface(const PointsRef& points, const PointsRef& normals, double radius)
    : first_step_(static_cast<int>(std::floor(std::log(0.1 * radius) / kPairDistanceStep))) {
  const Eigen::Vector3f middle = points.rowwise().mean();
  points_ = ((points.colwise() - middle) / static_cast<float>(radius)).transpose();
  normals_ = normals.transpose();
  for (int step = first_step_ + 1;; ++step) {
    const double distance = std::exp(kPairDistanceStep * step) / radius;
    if (distance > 2.1) break;  // the diameter, with rounding
    sq_distances_.push_back(static_cast<float>(distance * distance));
  }
}

PairRow PairedSurface::row(int i) const {
  static const std::vector<float> limits = cosineLimits<kPairAngles>(kPi);
  static const std::vector<float> other_limits = cosineLimits<kPairOtherAngles>(0.5 * kPi);
  const Eigen::Matrix3f frame = frameOf(normals_.row(i).matrix().transpose().cast<double>()).cast<float>();
  const Eigen::ArrayX3f lines = points_.rowwise() - points_.row(i);
  const auto along = [](const Eigen::Vector3f& axis, const Eigen::ArrayX3f& vectors) -> Eigen::ArrayXf {
    return axis.x() * vectors.col(0) + axis.y() * vectors.col(1) + axis.z() * vectors.col(2);
  };
  const auto dot = [](const Eigen::ArrayX3f& a, const Eigen::ArrayX3f& b) -> Eigen::ArrayXf {
    return a.col(0) * b.col(0) + a.col(1) * b.col(1) + a.col(2) * b.col(2);
  };
  const Eigen::ArrayXf sq_distances = dot(lines, lines), inverse = 1.0f / (sq_distances + kTiny).sqrt();
  PairRow row;
  row.distance = sq_distances.sqrt();
  row.distance_step = Eigen::ArrayXi::Constant(lines.rows(), first_step_);
  for (const float limit : sq_distances_) row.distance_step += (sq_distances >= limit).cast<int>();
  row.angle_step = limitsReached(along(frame.col(0), lines) * inverse, limits);
  row.other_step = limitsReached(dot(normals_, lines).abs() * inverse, other_limits);
  row.between_step = limitsReached(along(frame.col(0), normals_).abs(), other_limits);
  row.rotation = anglesOf(along(frame.col(1), lines), along(frame.col(2), lines));
  return row;
}

}  // namespace pcl_symmetry
