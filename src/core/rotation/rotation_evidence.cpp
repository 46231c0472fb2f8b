#include "core/rotation/rotation_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/rotation_confidence_fit.h"
#include "pcl_symmetry/core/rotation_group.h"

namespace pcl_symmetry {

namespace {

/// The line, moved by tilts about the two directions perpendicular to it and by translations along them.
Line3d movedLine(const Line3d& line, const Eigen::Vector4d& by) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  return {line.origin() + by[2] * u + by[3] * v, (line.direction() + by[0] * u + by[1] * v).normalized()};
}

/// The rotations about the lines on either side of a line, at kScanAxes.fit_step.
std::array<Eigen::Isometry3d, 4> motionsBeside(const Line3d& line, double angle) {
  std::array<Eigen::Isometry3d, 4> beside;
  for (int k = 0; k < 4; ++k)
    beside[k] = motionAbout(movedLine(line, kScanAxes.fit_step * Eigen::Vector4d::Unit(k)), angle);
  return beside;
}

/// How fast a point moves along a direction with each parameter of the line.
Eigen::Vector4d slopeOf(const std::array<Eigen::Isometry3d, 4>& beside, const Eigen::Vector3d& x,
                        const Eigen::Vector3d& moved, const Eigen::Vector3d& along) {
  Eigen::Vector4d slope;
  for (int k = 0; k < 4; ++k) slope[k] = along.dot(beside[k] * x - moved) / kScanAxes.fit_step;
  return slope;
}

/// HalfTurnEvidence::planes_off_share.
double planesOffShare(const RotationEvidence& evidence, const Line3d& line) {
  constexpr double kStep = 0.5 * kPi / kScanAxes.num_plane_pairs;  // radians; pairs repeat after a right angle
  const auto cost = [&](double angle) {
    double sum = 0.0;
    for (const double rotated : {angle, angle + 0.5 * kPi}) {
      const RotationShares shares = evidence.screen(planeThrough(line, rotated).reflection(), 1.0, 1.0);
      sum += shares.off - kScanAxes.landed_counts * shares.on;
    }
    return sum;
  };
  double best = 0.0, least = cost(0.0);
  const auto take = [&](double angle) {
    const double of_angle = cost(angle);
    if (of_angle >= least) return;
    least = of_angle;
    best = angle;
  };
  for (int k = 1; k < kScanAxes.num_plane_pairs; ++k) take(k * kStep);
  const double coarse = best;
  for (const double beside : {-0.5 * kStep, 0.5 * kStep}) take(coarse + beside);
  return std::max(evidence.measure(planeThrough(line, best).reflection()).off,
                  evidence.measure(planeThrough(line, best + 0.5 * kPi).reflection()).off);
}

/// HalfTurnEvidence::extent_ratio.
double extentRatio(const NormalizedCloud& cloud, const Eigen::Affine3d& rotation) {
  const Eigen::Index size = cloud.points.cols();
  Points both(3, 2 * size);
  both.leftCols(size) = cloud.points;
  both.rightCols(size) = rotation.cast<float>() * cloud.points;
  return std::max(1.0, approximateDiameter(both) / cloud.diameter);
}

/// Whether two lines, normalized frame, cross at a right angle.
bool crossesUpright(const Line3d& a, const Line3d& b) {
  const Eigen::Vector3d across = a.direction().cross(b.direction()).normalized();
  return std::abs(a.direction().dot(b.direction())) < std::sin(kScanAxes.upright_angle) &&
         std::abs(across.dot(a.origin() - b.origin())) < kScanAxes.crossing_gap;
}

}  // namespace

RotationEvidence::RotationEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed)
    : cloud_(cloud),
      tolerance_(tolerance),
      far_(kRotation.far_tolerances * tolerance),
      greatest_disc_(kEvidence.disc_radius * static_cast<double>(*std::max_element(cloud.geometry.spacing.begin(),
                                                                                   cloud.geometry.spacing.end()))),
      samples_(drawSamples(cloud.points.cols(), kScanAxes.num_samples, seed)),
      few_samples_(drawSamples(cloud.points.cols(), kScanAxes.num_few_samples, seed)),
      facing_(normalsToward(cloud.geometry.normals, cloud.points, cloud.visibility->viewpoint().cast<float>())) {}

RotationShares RotationEvidence::screen(const Eigen::Affine3d& motion, double max_off, double max_far) const {
  RotationShares shares;
  const double one = 1.0 / static_cast<double>(few_samples_.size());
  const auto fAt = [&](double distance) { return std::exp(-std::pow(distance / cloud_.sigma, 2)); };
  const double near_f = fAt(kScanAxes.screening_slack * tolerance_), far_f = fAt(far_);
  for (const int sample : few_samples_) {
    if (shares.off > max_off || shares.far > max_far) break;
    const Eigen::Vector3d x = motion * cloud_.points.col(sample).cast<double>();
    const double f = std::max(kScanAxes.min_f, cloud_.edt(cloud_.toInput(x)));
    if (f >= near_f) {
      shares.on += one;
    } else if (isFree(x)) {
      shares.off += one;
      shares.far += f < far_f ? one : 0.0;
    }
  }
  return shares;
}

Points RotationEvidence::moved(const Eigen::Affine3d& motion, const std::vector<int>& samples) const {
  Points moved(3, samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    moved.col(i) = (motion * cloud_.points.col(samples[i]).cast<double>()).cast<float>();
  return moved;
}

Landing RotationEvidence::landMoved(Points images, double farthest) const {
  Landing landing = land(cloud_.surface, std::move(images), kScanAxes.slack_of_reach * (farthest + greatest_disc_));
  landing.distances = surfaceDistances(landing.images, landing.closest, cloud_.samples);
  return landing;
}

RotationShares RotationEvidence::measure(const Eigen::Affine3d& motion) const {
  const Landing all = landMoved(moved(motion, samples_), far_);
  RotationShares shares;
  const double one = 1.0 / static_cast<double>(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (all.distances[i] <= tolerance_) {
      shares.on += one;
    } else if (isFree(all.images.col(i).cast<double>())) {
      shares.off += one;
      shares.far += all.distances[i] > far_ ? one : 0.0;
    }
  }
  return shares;
}

std::vector<int> RotationEvidence::samplesOffBody(const Line3d& line) const {
  std::vector<char> is_far(samples_.size(), false);
  std::vector<int> some;
  const double too_many = kScanAxes.max_off_body * static_cast<double>(samples_.size());
  for (int k = 1; k <= kScanAxes.round_rotations && static_cast<double>(some.size()) < too_many; ++k) {
    const Points images = moved(motionAbout(line, 2.0 * kPi * goldenFraction(k)), samples_);
    std::vector<int> free;  // those that may be far
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (!is_far[i] && isFree(images.col(i).cast<double>())) free.push_back(static_cast<int>(i));
    const std::vector<float> distances = landMoved(pointsAt(images, free), far_).distances;
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (!(distances[i] > far_)) continue;
      is_far[free[i]] = true;
      some.push_back(free[i]);
    }
  }
  return some;
}

double RotationEvidence::shareOn(const Eigen::Affine3d& motion, const std::vector<int>& some) const {
  const Landing all = landMoved(moved(motion, samples_), tolerance_);
  const auto count = std::count_if(some.begin(), some.end(), [&](int i) { return all.distances[i] <= tolerance_; });
  return static_cast<double>(count) / static_cast<double>(some.size());
}

double RotationEvidence::stiffness(const Line3d& line, double angle) const {
  const Eigen::Isometry3d motion = motionAbout(line, angle);
  const std::array<Eigen::Isometry3d, 4> beside = motionsBeside(line, angle);
  const Landing all = landMoved(moved(motion, samples_), tolerance_);
  Eigen::Matrix4d stiffness = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (all.closest[i] < 0 || all.distances[i] > tolerance_) continue;
    const Eigen::Vector3d x = cloud_.points.col(samples_[i]).cast<double>();
    const Eigen::Vector4d slope = slopeOf(beside, x, motion * x, facing_.col(all.closest[i]).cast<double>());
    stiffness += slope * slope.transpose() / static_cast<double>(samples_.size());
  }
  return std::max(0.0, SymmetricEigen<Eigen::Matrix4d>(stiffness).eigenvalues()[1]);
}

void RotationEvidence::addEquations(const IspSurface& surface, const Line3d& line, double angle,
                                    const std::vector<int>& samples, double width, std::vector<int>& closest,
                                    LineEquations& equations) const {
  const double sq_width = width * width * tolerance_ * tolerance_;
  const Eigen::Isometry3d motion = motionAbout(line, angle);
  const std::array<Eigen::Isometry3d, 4> beside = motionsBeside(line, angle);
  const Landing landing = land(surface, moved(motion, samples), kScanAxes.fit_reach * width * tolerance_, &closest);
  closest = landing.closest;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (closest[i] < 0) continue;
    const Eigen::Vector3d x = cloud_.points.col(samples[i]).cast<double>(), y = motion * x;
    const Eigen::Vector3d miss = y - cloud_.points.col(closest[i]).cast<double>();
    Eigen::Vector3d along;
    double weight = std::exp(-landing.sq_distances[i] / sq_width);
    if (cloud_.geometry.at_border[closest[i]]) {
      if (miss.norm() < kScanAxes.min_free_miss * tolerance_ || cloud_.visibility->depthBehind(y) >= 0.0) continue;
      along = miss.normalized();
    } else {
      const Eigen::Vector3d there = facing_.col(closest[i]).cast<double>(),
                            moved_normal = motion.linear() * facing_.col(samples[i]).cast<double>();
      const double cosine = there.dot(moved_normal);
      if (cosine <= 0.0) continue;
      weight *= cosine * cosine;
      along = (there + moved_normal).normalized();
    }
    const Eigen::Vector4d slope = slopeOf(beside, x, y, along);
    equations.squares += weight * slope * slope.transpose();
    equations.sum -= weight * along.dot(miss) * slope;
  }
}

Line3d RotationEvidence::fitLine(const IspSurface& surface, const Line3d& start, const std::vector<double>& angles,
                                 const std::vector<int>& samples, const ScanAxisRules::Widths& widths) const {
  // The tilts are about the point of the line in the middle of the points, so that they and the translations are
  // independent.
  Line3d line(start.projection(Eigen::Vector3d::Zero()), start.direction());
  std::vector<std::vector<int>> closest(angles.size(), std::vector<int>(samples.size(), -1));
  for (const double width : widths) {
    LineEquations equations;
    for (std::size_t k = 0; k < angles.size(); ++k)
      addEquations(surface, line, angles[k], samples, width, closest[k], equations);
    equations.squares.diagonal().array() += kScanAxes.fit_ridge * equations.squares.trace() + kScanAxes.min_f;
    const Eigen::Vector4d step = solveSymmetric(equations.squares, equations.sum);
    line = movedLine(line, step * std::min(1.0, kScanAxes.longest_step / std::max(kScanAxes.fit_step, step.norm())));
    line.origin() = line.projection(Eigen::Vector3d::Zero());
  }
  return line;
}

Line3d RotationEvidence::refineLine(const Line3d& start, const std::vector<double>& angles) const {
  return fitLine(cloud_.quick_surface, start, angles, few_samples_, kScanAxes.fit_widths);
}

Line3d RotationEvidence::refineLineClosely(const Line3d& start, const std::vector<double>& angles) const {
  return fitLine(cloud_.surface, start, angles, samples_, kScanAxes.close_fit_widths);
}

std::vector<HalfTurnEvidence> halfTurnEvidence(const RotationEvidence& evidence,
                                               const std::vector<SymmetryRotation>& rotations, double min_confidence,
                                               int num_threads) {
  const NormalizedCloud& cloud = evidence.cloud();
  std::vector<HalfTurnEvidence> half_turns(rotations.size());
  const auto best =
      std::max_element(rotations.begin(), rotations.end(),
                       [](const SymmetryRotation& a, const SymmetryRotation& b) { return marginOf(a) < marginOf(b); });
  parallelBlocks(rotations.size(), num_threads, [&](std::size_t i) {
    if (rotations[i].fold != 2) return;
    const Line3d line = cloud.lineOf(rotations[i]);
    half_turns[i].extent_ratio = extentRatio(cloud, motionAbout(line, kPi));
    half_turns[i].stiffness = evidence.stiffness(line, kPi);
    const bool is_best = marginOf(rotations[i]) >= marginOf(*best);
    half_turns[i].conflicts_with_best = is_best || crossesUpright(line, cloud.lineOf(*best)) ? 0.0 : 1.0;
    // Planes can only be evidence against a rotation, and they take most of the time.
    if (rotationConfidence(rotations[i], half_turns[i]) >= min_confidence)
      half_turns[i].planes_off_share = planesOffShare(evidence, line);
  });
  return half_turns;
}

RotationKind kindOf(const SymmetryRotation& rotation) {
  return rotation.fold == 0 ? RotationKind::AnyAngle : rotation.fold == 2 ? RotationKind::Half : RotationKind::Folds;
}

std::vector<double> rotationOddsTerms(const SymmetryRotation& rotation, const HalfTurnEvidence& half_turns) {
  const double off = std::log1p(rotation.off / kScanAxes.negligible_share),
               far = std::log1p(rotation.far / kScanAxes.negligible_share);
  switch (kindOf(rotation)) {
    case RotationKind::Half:  // without `far`, which `extent_ratio` and `off` cover
      return {1.0,
              off,
              1.0 - rotation.support,
              std::log(half_turns.extent_ratio),
              -std::log1p(half_turns.stiffness / kScanAxes.min_stiffness),
              std::log1p(half_turns.planes_off_share / kScanAxes.negligible_of_planes),
              half_turns.conflicts_with_best};
    case RotationKind::Folds:
      return {1.0,
              off,
              far,
              1.0 - rotation.support,
              std::min(kScanAxes.max_halfway, rotation.halfway - rotation.off),
              1.0 / rotation.fold};
    default:
      return {1.0, off, far, 1.0 - rotation.support};
  }
}

double rotationConfidence(const SymmetryRotation& rotation, const HalfTurnEvidence& half_turns) {
  const std::vector<double> terms = rotationOddsTerms(rotation, half_turns);
  const std::vector<double>& numbers = kRotationConfidenceFit[static_cast<std::size_t>(kindOf(rotation))];
  return logistic(std::inner_product(terms.begin(), terms.end(), numbers.begin(), 0.0));
}

}  // namespace pcl_symmetry
