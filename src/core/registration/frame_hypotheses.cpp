#include "core/registration/frame_hypotheses.h"

#include <algorithm>

#include "core/base/constants.h"
#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {

namespace {

// Turns about an axis of revolution. chosen: steps of 45 degrees; half leaves handles out of reach of the search, twice
// takes twice the time.
constexpr int kNumTurns = 8;
// Radians, rotations closer than this are one. chosen: the search reaches further than 10 degrees; half takes more
// time, twice leaves starts out of reach.
constexpr double kSameRotation = 10.0 * kDegree;

/// The rotations about an axis of revolution that stand for all of them; the identity alone where there is no such
/// axis.
std::vector<Eigen::Matrix3d> turnsOf(const SymmetryFrame& frame) {
  const bool turns = frame.revolution_axis >= 0 && frame.revolution_axis < 3;
  std::vector<Eigen::Matrix3d> rotations{Eigen::Matrix3d::Identity()};
  for (int turn = 1; turns && turn < kNumTurns; ++turn)
    rotations.push_back(Eigen::AngleAxisd(2.0 * kPi * turn / kNumTurns, Eigen::Vector3d::Unit(frame.revolution_axis))
                            .toRotationMatrix());
  return rotations;
}

}  // namespace

std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b) {
  const Eigen::Isometry3d T_b_canonical = b.T_canonical_input.inverse();
  const std::vector<Eigen::Matrix3d> turns = turnsOf(a);
  std::vector<Eigen::Isometry3d> hypotheses;
  const auto add = [&](const Eigen::Isometry3d& hypothesis) {
    const auto same = [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(other.linear().transpose() * hypothesis.linear()).angle() < kSameRotation;
    };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), same)) hypotheses.push_back(hypothesis);
  };
  for (const Eigen::Matrix3i& rotation : axisRotations()) {
    for (const Eigen::Matrix3d& turn : turns) {
      const Eigen::Isometry3d turned(Eigen::Matrix3d(rotation.cast<double>() * turn));
      for (std::size_t i = 0; i < a.num_maxima; ++i) add(T_b_canonical * turned * a.equivalent[i]);
    }
  }
  return hypotheses;
}

}  // namespace pcl_symmetry
