#include "core/registration/frame_hypotheses.h"

#include <algorithm>

#include "core/base/constants.h"
#include "core/geometry/axis_rotations.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// The rotations about an axis of revolution that represent all of them; the identity alone where there is no such
/// axis.
std::vector<Eigen::Matrix3d> rotationsOf(const SymmetryFrame& frame) {
  const bool is_round = frame.revolution_axis >= 0 && frame.revolution_axis < 3;
  std::vector<Eigen::Matrix3d> rotations{Eigen::Matrix3d::Identity()};
  for (int k = 1; is_round && k < kRegistration.num_rotations; ++k)
    rotations.push_back(
        Eigen::AngleAxisd(2.0 * kPi * k / kRegistration.num_rotations, Eigen::Vector3d::Unit(frame.revolution_axis))
            .toRotationMatrix());
  return rotations;
}

}  // namespace

std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b) {
  const Eigen::Isometry3d T_b_canonical = b.T_canonical_input.inverse();
  const std::vector<Eigen::Matrix3d> about_axis = rotationsOf(a);
  std::vector<Eigen::Isometry3d> hypotheses;
  const auto add = [&](const Eigen::Isometry3d& hypothesis) {
    const auto same = [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(other.linear().transpose() * hypothesis.linear()).angle() < kRegistration.same_rotation;
    };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), same)) hypotheses.push_back(hypothesis);
  };
  for (const Eigen::Matrix3i& order : axisRotations()) {
    for (const Eigen::Matrix3d& rotation : about_axis) {
      const Eigen::Isometry3d rotated(Eigen::Matrix3d(order.cast<double>() * rotation));
      for (std::size_t i = 0; i < a.num_maxima; ++i) add(T_b_canonical * rotated * a.equivalent[i]);
    }
  }
  return hypotheses;
}

}  // namespace pcl_symmetry
