/// Equivalent poses of a symmetric object. With a pose T and a symmetry S of the object, T S looks like T. All
/// symmetries fix the center, so only rotations differ between poses that look the same.

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/small_motion.h"
#include "core/geometry/directions.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry {

namespace {

// Differences of traces and entries of rotation matrices below this are rounding errors.
constexpr double kEqual = 1e-9;

using Poses = std::vector<Eigen::Isometry3d>;

bool isSphere(const ObjectSymmetries& symmetries) {
  return symmetries.continuous.size() >= 2;
}

/// The pose with a given rotation that puts the center where \p T puts it.
Eigen::Isometry3d withRotation(const Eigen::Isometry3d& T, const Eigen::Matrix3d& rotation,
                               const Eigen::Vector3d& center) {
  return isometry(rotation, T * center - rotation * center);
}

/// The traces of M C for the rotations C by phi about an axis: along + swing cos(phi - angle).
struct RotationTraces {
  double along, swing, angle;
};

RotationTraces rotationTraces(const Eigen::Matrix3d& M, const Eigen::Vector3d& axis) {
  const double along = axis.dot(M * axis), cosine = M.trace() - along;
  const Eigen::Vector3d twist(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
  const double sine = -axis.dot(twist);
  return {along, std::hypot(cosine, sine), std::atan2(sine, cosine)};
}

/// The symmetry D or D C of an object that brings a rotation closest to another one.
struct ClosestSymmetry {
  int element = -1;    ///< D, index into discrete; -1 is the identity
  double angle = 0.0;  ///< angle of the rotation C
};

/// The closest symmetry; of equally close elements, the first one.
/// \param M R_previous^T R: the symmetry S with the greatest trace of M S is the closest.
ClosestSymmetry closestSymmetry(const ObjectSymmetries& symmetries, const Eigen::Matrix3d& M) {
  ClosestSymmetry closest;
  double best = -std::numeric_limits<double>::infinity();
  for (int k = -1; k < static_cast<int>(symmetries.discrete.size()); ++k) {
    const Eigen::Matrix3d MD = k < 0 ? M : Eigen::Matrix3d(M * symmetries.discrete[k].linear());
    double trace = MD.trace(), angle = 0.0;
    if (!symmetries.continuous.empty()) {
      const RotationTraces about = rotationTraces(MD, symmetries.continuous.front().axis);
      trace = about.along + about.swing;
      angle = about.angle;
    }
    if (trace <= best + kEqual) continue;
    best = trace;
    closest = {k, angle};
  }
  return closest;
}

/// The rotation R C with the smallest angle, for rotations C about an axis. If R is a half turn about a line
/// perpendicular to the axis, all have the angle pi: then it is the one closest to a half turn about a fixed line.
Eigen::Matrix3d smallestRotation(const Eigen::Matrix3d& R, const Eigen::Vector3d& axis) {
  RotationTraces traces = rotationTraces(R, axis);
  if (traces.swing < 1e-6) {
    const Eigen::Matrix3d fixed = rotationAbout(axis.unitOrthogonal(), kPi);
    traces = rotationTraces(fixed.transpose() * R, axis);
  }
  return R * rotationAbout(axis, traces.angle);
}

/// The rotation with the smallest angle, and among equals the one whose matrix is greatest column by column.
Eigen::Matrix3d firstOf(std::vector<Eigen::Matrix3d> rotations) {
  const auto keepGreatest = [&](const auto& value) {
    double greatest = -std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& rotation : rotations) greatest = std::max(greatest, value(rotation));
    const auto isLess = [&](const Eigen::Matrix3d& rotation) { return value(rotation) < greatest - kEqual; };
    eraseIf(rotations, isLess);
  };
  keepGreatest([](const Eigen::Matrix3d& rotation) { return rotation.trace(); });
  for (int i = 0; i < 9 && rotations.size() > 1; ++i)
    keepGreatest([i](const Eigen::Matrix3d& rotation) { return rotation(i); });
  return rotations.front();
}

/// The greatest of the squared distances of points in two poses.
double greatestSqOffset(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2, const PointsRef& points) {
  const Eigen::Matrix3d A = T_1.linear() - T_2.linear();
  const Eigen::Vector3d b = T_1.translation() - T_2.translation();
  double greatest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    greatest = std::max(greatest, (A * points.col(i).cast<double>() + b).squaredNorm());
  return greatest;
}

/// The squared distance of a point from one that rotates about an axis: mean + cosine cos(phi) + sine sin(phi).
struct CircleWave {
  double mean, cosine, sine;
};

/// The angle at which the greatest of some waves is least: minima of samples, each refined.
/// \return radians.
double circleMinimax(const std::vector<CircleWave>& waves) {
  const auto greatest = [&](double phi) {
    const double c = std::cos(phi), s = std::sin(phi);
    double most = -std::numeric_limits<double>::infinity();
    for (const CircleWave& wave : waves) most = std::max(most, wave.mean + wave.cosine * c + wave.sine * s);
    return most;
  };
  constexpr int num_samples = 720;
  constexpr double step = 2.0 * kPi / num_samples;
  std::vector<double> samples;
  for (int k = 0; k < num_samples; ++k) samples.push_back(greatest(k * step));
  std::pair<double, double> best{0.0, samples[0]};
  for (int k = 0; k < num_samples; ++k) {
    if (samples[k] > samples[(k + 1) % num_samples] || samples[k] > samples[(k + num_samples - 1) % num_samples])
      continue;
    const auto minimum = boost::math::tools::brent_find_minima(greatest, (k - 1) * step, (k + 1) * step, 48);
    if (minimum.second < best.second) best = minimum;
  }
  return best.first;
}

/// The rotation about an axis that brings points closest to their images under a motion.
/// \return its angle, radians.
double closestAngle(const Eigen::Isometry3d& motion, const ContinuousSymmetry& symmetry, const PointsRef& points) {
  std::vector<CircleWave> waves(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d from_axis = points.col(i).cast<double>() - symmetry.offset;
    const Eigen::Vector3d target = motion * points.col(i).cast<double>() - symmetry.offset;
    const double height = from_axis.dot(symmetry.axis);
    const Eigen::Vector3d arm = from_axis - height * symmetry.axis;
    const double mean = target.squaredNorm() + from_axis.squaredNorm() - 2.0 * height * target.dot(symmetry.axis);
    waves[i] = {mean, -2.0 * target.dot(arm), -2.0 * target.dot(symmetry.axis.cross(arm))};
  }
  return circleMinimax(waves);
}

}  // namespace

Poses ObjectSymmetries::equivalents(const Eigen::Isometry3d& T, double step) const {
  check(step > 0.0, "step", step, "> 0");
  Poses symmetries{Eigen::Isometry3d::Identity()};
  double angle_step = step;
  if (isSphere(*this)) {
    // A rotation by step / sqrt(2) and a tilt by step / sqrt(8) come within step / 2 of any rotation.
    angle_step = std::sqrt(0.5) * step;
    symmetries.clear();
    for (const Eigen::Matrix3d& tilt : tiltsCovering(continuous.front().axis, std::min(kPi, 0.5 * angle_step)))
      symmetries.push_back(motionFixing(center, tilt));
  } else {
    symmetries.insert(symmetries.end(), discrete.begin(), discrete.end());
  }
  const int num_angles =
      continuous.empty() ? 1 : std::max(1, static_cast<int>(std::ceil(2.0 * kPi / angle_step - kEqual)));
  Poses poses;
  for (const Eigen::Isometry3d& symmetry : symmetries) {
    poses.push_back(T * symmetry);
    for (int k = 1; k < num_angles; ++k)
      poses.push_back(
          T * motionAbout({continuous.front().offset, continuous.front().axis}, 2.0 * kPi * k / num_angles) * symmetry);
  }
  return poses;
}

Eigen::Isometry3d ObjectSymmetries::closestTo(const Eigen::Isometry3d& T, const Eigen::Isometry3d& T_previous) const {
  if (isSphere(*this)) return withRotation(T, T_previous.linear(), center);
  const ClosestSymmetry closest = closestSymmetry(*this, T_previous.linear().transpose() * T.linear());
  const Eigen::Isometry3d placed = closest.element < 0 ? T : T * discrete[closest.element];
  return continuous.empty() ? placed
                            : placed * motionAbout({continuous.front().offset, continuous.front().axis}, closest.angle);
}

Eigen::Isometry3d ObjectSymmetries::canonical(const Eigen::Isometry3d& T) const {
  if (isSphere(*this)) return withRotation(T, Eigen::Matrix3d::Identity(), center);
  std::vector<Eigen::Matrix3d> rotations;
  for (int k = -1; k < static_cast<int>(discrete.size()); ++k) {
    const Eigen::Matrix3d R = k < 0 ? T.linear() : Eigen::Matrix3d(T.linear() * discrete[k].linear());
    rotations.push_back(continuous.empty() ? R : smallestRotation(R, continuous.front().axis));
  }
  return withRotation(T, firstOf(std::move(rotations)), center);
}

PoseDistance ObjectSymmetries::distance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2) const {
  const Eigen::Quaterniond R_1(T_1.linear()), R_2(closestTo(T_2, T_1).linear());
  return {R_1.angularDistance(R_2), (T_1 * center - T_2 * center).norm()};
}

double ObjectSymmetries::surfaceDistance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2,
                                         const PointsRef& points) const {
  check(points.cols() > 0, "number of points", points.cols(), ">= 1");
  if (isSphere(*this)) return (T_1 * center - T_2 * center).norm();
  double best = greatestSqOffset(T_1, closestTo(T_2, T_1), points);
  for (int k = -1; k < static_cast<int>(discrete.size()); ++k) {
    Eigen::Isometry3d placed = k < 0 ? T_2 : T_2 * discrete[k];
    if (!continuous.empty()) {
      const double angle = closestAngle(placed.inverse() * T_1, continuous.front(), points);
      placed = placed * motionAbout({continuous.front().offset, continuous.front().axis}, angle);
    }
    best = std::min(best, greatestSqOffset(T_1, placed, points));
  }
  return std::sqrt(best);
}

}  // namespace pcl_symmetry
