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

}  // namespace pcl_symmetry
