/// Poses of a symmetric object: which of those that look the same. With a pose T and a symmetry S of the object, T S
/// looks like T. All symmetries fix the center, so only rotations differ between poses that look the same.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/rotation/circle_minimax.h"
#include "core/rotation/rotation_cover.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry {

namespace {

// Difference of traces and entries of rotation matrices that counts as none. derived: far above the rounding that poses
// of one class differ by, far below the difference of two of their representatives but by rare chance.
constexpr double kEqual = 1e-9;
// Length below which the direction of a turn is not defined. derived: rounding turns it by 1e-16 over this.
constexpr double kUndirected = 1e-6;
// Poses from which a mean is searched. chosen: half misses the best one of many wide sets, twice takes twice the time.
constexpr std::size_t kMaxStarts = 32;
// Steps of a mean, and the change at which it stands still. derived: steps shrink by a factor each; rounding is 1e-16.
constexpr int kMaxSteps = 100;
constexpr double kStill = 1e-14;

using Poses = std::vector<Eigen::Isometry3d>;

bool isSphere(const ObjectSymmetries& symmetries) {
  return symmetries.continuous.size() >= 2;
}

Eigen::Isometry3d motionAbout(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& fixed) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation;
  motion.translation() = fixed - rotation * fixed;
  return motion;
}

Eigen::Isometry3d turnOf(const ContinuousSymmetry& symmetry, double angle) {
  return motionAbout(rotationAbout(symmetry.axis, angle), symmetry.offset);
}

/// The pose with a given rotation that puts the center where another pose puts it.
Eigen::Isometry3d withRotation(const Eigen::Isometry3d& T, const Eigen::Matrix3d& rotation,
                               const Eigen::Vector3d& center) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation;
  result.translation() = T * center - rotation * center;
  return result;
}

/// The traces of M C for the turns C by phi about an axis: along + swing cos(phi - angle).
struct TurnTraces {
  double along, swing, angle;
};

TurnTraces turnTraces(const Eigen::Matrix3d& M, const Eigen::Vector3d& axis) {
  const double along = axis.dot(M * axis), cosine = M.trace() - along;
  const Eigen::Vector3d twist(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
  const double sine = -axis.dot(twist);
  return {along, std::hypot(cosine, sine), std::atan2(sine, cosine)};
}

/// The trace of a product, which is the greater the smaller the angle of the product is.
double traceOf(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return a.cwiseProduct(b.transpose()).sum();
}

/// The symmetry D or D C of an object that takes a rotation closest to another one.
struct ClosestSymmetry {
  int element = -1;    ///< D, index into discrete; -1 is the identity
  double angle = 0.0;  ///< of the turn C
};

/// Of elements that come equally close the first one.
/// \param M R_previous^T R: the symmetry S with the greatest trace of M S is the closest.
ClosestSymmetry closestSymmetry(const ObjectSymmetries& symmetries, const Eigen::Matrix3d& M) {
  ClosestSymmetry closest;
  double best = -std::numeric_limits<double>::infinity();
  for (int k = -1; k < static_cast<int>(symmetries.discrete.size()); ++k) {
    double trace = 0.0, angle = 0.0;
    if (symmetries.continuous.empty()) {
      trace = k < 0 ? M.trace() : traceOf(M, symmetries.discrete[k].linear());
    } else {
      const Eigen::Matrix3d MD = k < 0 ? M : Eigen::Matrix3d(M * symmetries.discrete[k].linear());
      const TurnTraces turns = turnTraces(MD, symmetries.continuous.front().axis);
      trace = turns.along + turns.swing;
      angle = turns.angle;
    }
    if (trace <= best + kEqual) continue;
    best = trace;
    closest = {k, angle};
  }
  return closest;
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::Quaterniond(a).angularDistance(Eigen::Quaterniond(b));
}

/// The rotation R C with a turn C about an axis that is turned least. A half turn about a line across the axis has no
/// such C: all of them turn by pi. There it is the one closest to a half turn about a fixed line.
Eigen::Matrix3d leastTurned(const Eigen::Matrix3d& R, const Eigen::Vector3d& axis) {
  TurnTraces turns = turnTraces(R, axis);
  if (turns.swing < kUndirected) {
    const Eigen::Matrix3d fixed = rotationAbout(axis.unitOrthogonal(), kPi);
    turns = turnTraces(fixed.transpose() * R, axis);
  }
  return R * rotationAbout(axis, turns.angle);
}

/// Of some rotations the one that is turned least, and among equals the one whose matrix is greatest column by column.
Eigen::Matrix3d firstOf(std::vector<Eigen::Matrix3d> rotations) {
  const auto keepGreatest = [&](const auto& value) {
    double greatest = -std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& rotation : rotations) greatest = std::max(greatest, value(rotation));
    const auto is_less = [&](const Eigen::Matrix3d& rotation) { return value(rotation) < greatest - kEqual; };
    rotations.erase(std::remove_if(rotations.begin(), rotations.end(), is_less), rotations.end());
  };
  keepGreatest([](const Eigen::Matrix3d& rotation) { return rotation.trace(); });
  for (int i = 0; i < 9 && rotations.size() > 1; ++i)
    keepGreatest([i](const Eigen::Matrix3d& rotation) { return rotation(i); });
  return rotations.front();
}

/// Squared distances of points in two poses, the greatest of them.
class GreatestOffset {
public:
  explicit GreatestOffset(const PointsRef& points) : points_(points) {}

  /// \param limit the search ends where a distance is not below it.
  double operator()(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2, double limit) {
    const Eigen::Matrix3d A = T_1.linear() - T_2.linear();
    const Eigen::Vector3d b = T_1.translation() - T_2.translation();
    const auto sq_offset = [&](Eigen::Index i) { return (A * points_.col(i).cast<double>() + b).squaredNorm(); };
    double greatest = sq_offset(worst_);
    for (Eigen::Index i = 0; i < points_.cols() && greatest < limit; ++i) {
      const double sq = sq_offset(i);
      if (sq > greatest) {
        greatest = sq;
        worst_ = i;
      }
    }
    return greatest;
  }

private:
  const PointsRef& points_;
  Eigen::Index worst_ = 0;  // the point that decided last decides soonest
};

/// The turn about an axis that brings points closest to where a motion takes them.
/// \return its angle, radians.
double closestTurn(const Eigen::Isometry3d& motion, const ContinuousSymmetry& symmetry, const PointsRef& points) {
  std::vector<CircleWave> waves(static_cast<std::size_t>(points.cols()));
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

/// A rotation between poses of a class, and its sum of sin^2 of half the angles to them.
struct MeanRotation {
  Eigen::Quaterniond rotation;
  double sum;
};

MeanRotation meanFrom(const ObjectSymmetries& symmetries, const Poses& poses, const Eigen::Isometry3d& start) {
  MeanRotation mean{Eigen::Quaterniond(start.linear()), std::numeric_limits<double>::infinity()};
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::Isometry3d current = Eigen::Isometry3d::Identity();
    current.linear() = mean.rotation.toRotationMatrix();
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    for (const Eigen::Isometry3d& T : poses) {
      const Eigen::Vector4d q = Eigen::Quaterniond(symmetries.closestTo(T, current).linear()).coeffs();
      moments += q * q.transpose();
    }
    // The unit quaternion with the least sum of 1 - (q . q_i)^2.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(moments);
    const double sum = static_cast<double>(poses.size()) - solver.eigenvalues()[3];
    if (sum >= mean.sum - kStill) break;
    mean = {Eigen::Quaterniond(solver.eigenvectors().col(3)), sum};
  }
  return mean;
}

}  // namespace

Poses ObjectSymmetries::equivalents(const Eigen::Isometry3d& T, double step) const {
  check(step > 0.0, "step", step, "> 0");
  Poses symmetries{Eigen::Isometry3d::Identity()};
  double turn_step = step;
  if (isSphere(*this)) {
    // derived: a turn by step / sqrt(2) and a tilt by step / sqrt(8) leave less than step / 2 of any rotation.
    turn_step = std::sqrt(0.5) * step;
    symmetries.clear();
    for (const Eigen::Matrix3d& tilt : tiltsCovering(continuous.front().axis, std::min(kPi, 0.5 * turn_step)))
      symmetries.push_back(motionAbout(tilt, center));
  } else {
    symmetries.insert(symmetries.end(), discrete.begin(), discrete.end());
  }
  const int num_turns =
      continuous.empty() ? 1 : std::max(1, static_cast<int>(std::ceil(2.0 * kPi / turn_step - kEqual)));
  Poses poses;
  for (const Eigen::Isometry3d& symmetry : symmetries) {
    poses.push_back(T * symmetry);
    for (int k = 1; k < num_turns; ++k)
      poses.push_back(T * turnOf(continuous.front(), 2.0 * kPi * k / num_turns) * symmetry);
  }
  return poses;
}

Eigen::Isometry3d ObjectSymmetries::closestTo(const Eigen::Isometry3d& T, const Eigen::Isometry3d& T_previous) const {
  if (isSphere(*this)) return withRotation(T, T_previous.linear(), center);
  const ClosestSymmetry closest = closestSymmetry(*this, T_previous.linear().transpose() * T.linear());
  const Eigen::Isometry3d placed = closest.element < 0 ? T : T * discrete[closest.element];
  return continuous.empty() ? placed : placed * turnOf(continuous.front(), closest.angle);
}

Eigen::Isometry3d ObjectSymmetries::canonical(const Eigen::Isometry3d& T) const {
  if (isSphere(*this)) return withRotation(T, Eigen::Matrix3d::Identity(), center);
  std::vector<Eigen::Matrix3d> rotations;
  for (int k = -1; k < static_cast<int>(discrete.size()); ++k) {
    const Eigen::Matrix3d R = k < 0 ? T.linear() : Eigen::Matrix3d(T.linear() * discrete[k].linear());
    rotations.push_back(continuous.empty() ? R : leastTurned(R, continuous.front().axis));
  }
  return withRotation(T, firstOf(std::move(rotations)), center);
}

PoseDistance ObjectSymmetries::distance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2) const {
  return {angleBetween(T_1.linear(), closestTo(T_2, T_1).linear()), (T_1 * center - T_2 * center).norm()};
}

double ObjectSymmetries::surfaceDistance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2,
                                         const PointsRef& points) const {
  check(points.cols() > 0, "number of points", points.cols(), ">= 1");
  if (isSphere(*this)) return (T_1 * center - T_2 * center).norm();
  GreatestOffset greatest(points);
  double best = greatest(T_1, closestTo(T_2, T_1), std::numeric_limits<double>::infinity());
  for (int k = -1; k < static_cast<int>(discrete.size()); ++k) {
    Eigen::Isometry3d placed = k < 0 ? T_2 : T_2 * discrete[k];
    if (!continuous.empty()) {
      const double angle = closestTurn(placed.inverse() * T_1, continuous.front(), points);
      placed = placed * turnOf(continuous.front(), angle);
    }
    best = std::min(best, greatest(T_1, placed, best));
  }
  return std::sqrt(best);
}

bool ObjectSymmetries::sameUpTo(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2, double max_angle,
                                double max_offset) const {
  const PoseDistance apart = distance(T_1, T_2);
  return apart.angle <= max_angle && apart.offset <= max_offset;
}

Eigen::Isometry3d ObjectSymmetries::mean(const Poses& poses) const {
  check(!poses.empty(), "number of poses", poses.size(), ">= 1");
  const std::size_t num_starts = std::min(poses.size(), kMaxStarts);
  MeanRotation best{Eigen::Quaterniond::Identity(), std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < num_starts; ++k) {
    const MeanRotation found = meanFrom(*this, poses, poses[k * poses.size() / num_starts]);
    if (found.sum < best.sum - kEqual) best = found;
  }
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& T : poses) place += T * center / static_cast<double>(poses.size());
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = best.rotation.normalized().toRotationMatrix();
  mean.translation() = place - mean.linear() * center;
  return closestTo(mean, poses.front());
}

}  // namespace pcl_symmetry
