#include "core/geometry/directions.h"

#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

Eigen::Vector3d directionAt(double z, double angle) {
  const double ring = std::sqrt(1.0 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

}  // namespace

double goldenFraction(int k) {
  return k * kGoldenSection - std::floor(k * kGoldenSection);
}

Eigen::Vector3d spiralDirection(int k, int count, double angle) {
  return directionAt((k + 0.5) / count, angle);
}

std::vector<Eigen::Vector3d> evenDirections(int num_directions) {
  check(num_directions >= 1, "num_directions", num_directions, ">= 1");
  // One unit in the last place below kGoldenAngle: stored signatures were made with these very directions.
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < num_directions; ++i)
    directions.push_back(directionAt(1.0 - (2.0 * i + 1.0) / num_directions, golden_angle * i));
  return directions;
}

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
