#include "evaluate/frames/mesh_ties.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry::apps {

namespace {

// Degrees between turns that are one. chosen: reference planes are exact to some tenths of a degree and products of
// several add up; at half one turn is listed twice, at twice turns of 36 folds would be one.
constexpr double kSameTurn = 5.0;
// Turns of a group at most. derived: an icosahedron has 60; bodies with more folds have an axis.
constexpr std::size_t kMostTurns = 120;

double angleOf(const Eigen::Matrix3d& turn) {
  return std::acos(std::clamp(0.5 * (turn.trace() - 1.0), -1.0, 1.0)) / kDegree;
}

/// The axes of a frame have no signs, so that a reflection does to them what the half-turn about its normal does.
Eigen::Matrix3d halfTurn(const Eigen::Vector3d& normal) {
  return 2.0 * normal * normal.transpose() - Eigen::Matrix3d::Identity();
}

/// All products of half-turns.
std::vector<Eigen::Matrix3d> groupOf(const std::vector<Eigen::Matrix3d>& generators) {
  std::vector<Eigen::Matrix3d> group{Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const Eigen::Matrix3d& generator : generators) {
      const Eigen::Matrix3d next = generator * group[i];
      const bool known = std::any_of(group.begin(), group.end(), [&](const Eigen::Matrix3d& other) {
        return angleOf(other.transpose() * next) < kSameTurn;
      });
      if (!known && group.size() < kMostTurns) group.push_back(next);
    }
  }
  return group;
}

/// The least angle of \p turn after any rotation about an axis; its trace has a closed form.
double leastAngle(const Eigen::Matrix3d& turn, const std::optional<Eigen::Vector3d>& axis) {
  if (!axis) return angleOf(turn);
  const Eigen::Vector3d& a = *axis;
  const double along = a.dot(turn * a), across = turn.trace() - along;
  const Eigen::Vector3d skew(turn(1, 2) - turn(2, 1), turn(2, 0) - turn(0, 2), turn(0, 1) - turn(1, 0));
  const double trace = along + std::hypot(across, a.dot(skew));
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0)) / kDegree;
}

}  // namespace

MeshTies tiesOf(const ReferenceSymmetries& references) {
  MeshTies ties;
  ties.all = !references.centers.empty() || references.axes.size() > 1;
  std::vector<Eigen::Matrix3d> generators;
  for (const ReferencePlane& plane : references.planes) generators.push_back(halfTurn(plane.plane.normal()));
  if (!references.axes.empty()) {
    ties.axis = references.axes.front().direction;
    generators.push_back(halfTurn(ties.axis->unitOrthogonal()));
  }
  ties.turns = groupOf(generators);
  return ties;
}

double angleUpToTies(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const MeshTies& ties) {
  if (ties.all) return 0.0;
  double least = 180.0;
  for (const Eigen::Matrix3d& turn : ties.turns) {
    for (const Eigen::Matrix3i& order : axisRotations())
      least = std::min(least, leastAngle(turn * b * order.cast<double>() * a.transpose(), ties.axis));
  }
  return least;
}

}  // namespace pcl_symmetry::apps
