#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {

namespace {

std::array<Eigen::Matrix3i, kNumAxisRotations> makeRotations() {
  // All orders of three axes, the three cyclic ones first
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<Eigen::Matrix3i, kNumAxisRotations> rotations;
  std::size_t count = 0;
  for (const auto& order : kOrders)
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3i rotation = Eigen::Matrix3i::Zero();
      for (int axis = 0; axis < 3; ++axis) rotation(order[axis], axis) = signs >> axis & 1 ? -1 : 1;
      if (rotation.determinant() == 1) rotations[count++] = rotation;
    }
  return rotations;
}

}  // namespace

const std::array<Eigen::Matrix3i, kNumAxisRotations>& axisRotations() {
  static const std::array<Eigen::Matrix3i, kNumAxisRotations> rotations = makeRotations();
  return rotations;
}

}  // namespace pcl_symmetry
