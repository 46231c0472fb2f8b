#include "core/detection/turn_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/detection/detection_rules.h"
#include "core/evidence/evidence_rules.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// Radius of the greatest disc that represents a point.
double greatestDisc(const LocalGeometry& geometry) {
  return kEvidence.disc_radius *
         static_cast<double>(*std::max_element(geometry.spacing.begin(), geometry.spacing.end()));
}

/// The normals of a scan, toward the scanner.
Points facingNormals(const NormalizedCloud& cloud, const Eigen::Vector3d& viewpoint) {
  Points facing = cloud.geometry.normals;
  for (Eigen::Index i = 0; i < facing.cols(); ++i)
    if (facing.col(i).dot(viewpoint.cast<float>() - cloud.points.col(i)) < 0.0f) facing.col(i) = -facing.col(i);
  return facing;
}

/// The line moved by tilts about the two directions across it and by shifts along them.
Line3d movedLine(const Line3d& line, const Eigen::Vector4d& by) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  return {line.origin() + by[2] * u + by[3] * v, (line.direction() + by[0] * u + by[1] * v).normalized()};
}

/// The rotations about the lines beside a line, by kDetection.rotations.fit_step.
std::array<Eigen::Isometry3d, 4> turnsBeside(const Line3d& line, double angle) {
  std::array<Eigen::Isometry3d, 4> beside;
  for (int k = 0; k < 4; ++k)
    beside[k] = turnAbout(movedLine(line, kDetection.rotations.fit_step * Eigen::Vector4d::Unit(k)), angle);
  return beside;
}

/// How fast a point moves along a direction as the line does.
Eigen::Vector4d slopeOf(const std::array<Eigen::Isometry3d, 4>& beside, const Eigen::Vector3d& x,
                        const Eigen::Vector3d& turned, const Eigen::Vector3d& along) {
  Eigen::Vector4d slope;
  for (int k = 0; k < 4; ++k) slope[k] = along.dot(beside[k] * x - turned) / kDetection.rotations.fit_step;
  return slope;
}

}  // namespace

Eigen::Isometry3d turnAbout(const Line3d& line, double angle) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(angle, line.direction()).toRotationMatrix();
  turn.translation() = line.origin() - turn.linear() * line.origin();
  return turn;
}

TurnEvidence::TurnEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed)
    : cloud_(cloud),
      tolerance_(tolerance),
      viewpoint_(cloud.visibility->viewpoint()),
      far_(kDetection.rotations.far_turn * tolerance),
      reach_(kDetection.rotations.slack_of_reach * (far_ + greatestDisc(cloud.geometry))),
      samples_(drawSamples(cloud.points.cols(), kDetection.rotations.samples_of_turn, seed)),
      few_samples_(drawSamples(cloud.points.cols(), kDetection.rotations.few_samples_of_turn, seed)),
      facing_(facingNormals(cloud, viewpoint_)) {}

bool TurnEvidence::isSeenEmpty(const Eigen::Vector3d& x) const {
  const Visibility& visibility = *cloud_.visibility;
  if (visibility.depthBehind(x) >= -tolerance_) return false;
  // The rim of what was seen is as exact as its pixels.
  const Eigen::Vector3d ray = (x - viewpoint_).normalized(), u = ray.unitOrthogonal(), v = ray.cross(u);
  for (const Eigen::Vector3d& aside : {u, v, Eigen::Vector3d(-u), Eigen::Vector3d(-v)})
    if (visibility.depthBehind(x + std::max(tolerance_, cloud_.spacing) * aside) >= -tolerance_) return false;
  return true;
}

TurnShares TurnEvidence::roughly(const Eigen::Affine3d& motion, double slack, double most_off, double most_far) const {
  TurnShares shares;
  const double one = 1.0 / static_cast<double>(few_samples_.size());
  const auto fAt = [&](double distance) { return std::exp(-std::pow(distance / cloud_.sigma, 2)); };
  const double near_f = fAt(slack * tolerance_), far_f = fAt(far_);
  for (const int sample : few_samples_) {
    if (shares.off > most_off || shares.far > most_far) break;
    const Eigen::Vector3d x = motion * cloud_.points.col(sample).cast<double>();
    const double f = std::max(kDetection.rotations.least_turn_f, cloud_.edt(cloud_.toInput(x)));
    if (f >= near_f) {
      shares.on += one;
    } else if (isSeenEmpty(x)) {
      shares.off += one;
      shares.far += f < far_f ? one : 0.0;
    }
  }
  return shares;
}

TurnEvidence::Moved TurnEvidence::moved(const Eigen::Affine3d& motion) const {
  Moved moved{Points(3, static_cast<Eigen::Index>(samples_.size())), {}, {}};
  for (std::size_t i = 0; i < samples_.size(); ++i)
    moved.points.col(static_cast<Eigen::Index>(i)) =
        (motion * cloud_.points.col(samples_[i]).cast<double>()).cast<float>();
  // Points beyond the reach only need to be known as far.
  ClosestPoints near = closestWithin(cloud_.surface, moved.points, reach_);
  moved.closest = std::move(near.indices);
  moved.distances = surfaceDistances(moved.points, moved.closest, cloud_.samples);
  for (std::size_t i = 0; i < samples_.size(); ++i)
    moved.distances[i] = std::min(moved.distances[i], std::sqrt(near.sq_distances[i]));
  return moved;
}

TurnShares TurnEvidence::exactly(const Eigen::Affine3d& motion) const {
  const Moved all = moved(motion);
  TurnShares shares;
  const double one = 1.0 / static_cast<double>(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (all.distances[i] <= tolerance_) {
      shares.on += one;
    } else if (isSeenEmpty(all.points.col(static_cast<Eigen::Index>(i)).cast<double>())) {
      shares.off += one;
      shares.far += all.distances[i] > far_ ? one : 0.0;
    }
  }
  return shares;
}

double TurnEvidence::hold(const Line3d& line, double angle) const {
  const Eigen::Isometry3d turn = turnAbout(line, angle);
  const std::array<Eigen::Isometry3d, 4> beside = turnsBeside(line, angle);
  const Moved all = moved(Eigen::Affine3d(turn));
  Eigen::Matrix4d stiffness = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (all.closest[i] < 0 || all.distances[i] > tolerance_) continue;
    const Eigen::Vector3d x = cloud_.points.col(samples_[i]).cast<double>();
    const Eigen::Vector4d slope = slopeOf(beside, x, turn * x, facing_.col(all.closest[i]).cast<double>());
    stiffness += slope * slope.transpose() / static_cast<double>(samples_.size());
  }
  return std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(stiffness).eigenvalues()[1]);
}

void TurnEvidence::addPulls(const Line3d& line, double angle, const std::vector<int>& samples, double width,
                            std::vector<int>& closest, Pulls& pulls) const {
  const double sq_width = width * width * tolerance_ * tolerance_;
  const Eigen::Isometry3d turn = turnAbout(line, angle);
  const std::array<Eigen::Isometry3d, 4> beside = turnsBeside(line, angle);
  Points turned(3, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    turned.col(static_cast<Eigen::Index>(i)) = (turn * cloud_.points.col(samples[i]).cast<double>()).cast<float>();
  const ClosestPoints found =
      closestWithin(cloud_.surface, turned, kDetection.rotations.fit_reach * width * tolerance_, &closest);
  closest = found.indices;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (closest[i] < 0) continue;
    const Eigen::Vector3d x = cloud_.points.col(samples[i]).cast<double>(), y = turn * x;
    const Eigen::Vector3d miss = y - cloud_.points.col(closest[i]).cast<double>();
    Eigen::Vector3d along;
    double weight = std::exp(-found.sq_distances[i] / sq_width);
    if (cloud_.geometry.at_border[closest[i]]) {
      if (miss.norm() < kDetection.rotations.least_empty_miss * tolerance_ || cloud_.visibility->depthBehind(y) >= 0.0)
        continue;
      along = miss.normalized();
    } else {
      const Eigen::Vector3d there = facing_.col(closest[i]).cast<double>(),
                            turned_normal = turn.linear() * facing_.col(samples[i]).cast<double>();
      const double cosine = there.dot(turned_normal);
      if (cosine <= 0.0) continue;
      weight *= cosine * cosine;
      along = (there + turned_normal).normalized();
    }
    const Eigen::Vector4d slope = slopeOf(beside, x, y, along);
    pulls.squares += weight * slope * slope.transpose();
    pulls.sum -= weight * along.dot(miss) * slope;
  }
}

Line3d TurnEvidence::fitted(const Line3d& start, const std::vector<double>& angles, const std::vector<int>& samples,
                            const std::array<double, 6>& widths) const {
  // Tilts about the point of the line among the points, so that they and the shifts are independent.
  Line3d line(start.projection(Eigen::Vector3d::Zero()), start.direction());
  std::vector<std::vector<int>> closest(angles.size(), std::vector<int>(samples.size(), -1));
  for (const double width : widths) {
    Pulls pulls;
    for (std::size_t k = 0; k < angles.size(); ++k) addPulls(line, angles[k], samples, width, closest[k], pulls);
    pulls.squares.diagonal().array() +=
        kDetection.rotations.fit_ridge * pulls.squares.trace() + kDetection.rotations.least_turn_f;
    const Eigen::Vector4d step = pulls.squares.ldlt().solve(pulls.sum);
    constexpr double kMostStep = 0.1;  // radians, radii; starts are closer, larger steps leave the basin
    line = movedLine(line, step * std::min(1.0, kMostStep / std::max(kDetection.rotations.fit_step, step.norm())));
    line.origin() = line.projection(Eigen::Vector3d::Zero());
  }
  return line;
}

Line3d TurnEvidence::refined(const Line3d& start, const std::vector<double>& angles) const {
  return fitted(start, angles, few_samples_, kDetection.rotations.fit_widths);
}

Line3d TurnEvidence::closelyRefined(const Line3d& start, const std::vector<double>& angles) const {
  return fitted(start, angles, samples_, kDetection.rotations.close_fit_widths);
}

}  // namespace pcl_symmetry
