#include "core/frame/frame_hypotheses.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {

std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b) {
  constexpr int kNumTurns = 8;
  constexpr double kSameAngle = 10.0 * M_PI / 180.0;
  const Eigen::Isometry3d T_b_canonical = b.T_canonical_input.inverse();
  std::vector<Eigen::Isometry3d> hypotheses;
  const auto add = [&](const Eigen::Isometry3d& hypothesis) {
    const auto same = [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(other.linear().transpose() * hypothesis.linear()).angle() < kSameAngle;
    };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), same)) hypotheses.push_back(hypothesis);
  };
  const bool turns = a.revolution_axis >= 0 && a.revolution_axis < 3;
  for (const Eigen::Matrix3i& rotation : axisRotations()) {
    for (int turn = 0; turn < (turns ? kNumTurns : 1); ++turn) {
      Eigen::Matrix3d turned = rotation.cast<double>();
      if (turns)
        turned *= Eigen::AngleAxisd(2.0 * M_PI * turn / kNumTurns, Eigen::Vector3d::Unit(a.revolution_axis))
                      .toRotationMatrix();
      for (std::size_t i = 0; i < a.num_maxima; ++i) add(T_b_canonical * Eigen::Isometry3d(turned) * a.equivalent[i]);
    }
  }
  return hypotheses;
}

}  // namespace pcl_symmetry
