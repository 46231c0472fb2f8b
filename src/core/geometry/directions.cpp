#include "core/geometry/directions.h"

#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"

namespace pcl_symmetry {

std::vector<Eigen::Vector3d> evenDirections(int num_directions) {
  check(num_directions >= 1, "num_directions", num_directions, ">= 1");
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < num_directions; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / num_directions, radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), z);
  }
  return directions;
}

}  // namespace pcl_symmetry
