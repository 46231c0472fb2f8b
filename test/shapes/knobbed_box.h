/// A box without symmetry.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/random.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::test {

/// Points drawn at random on the surface of a box from -half to half; every tenth one in a knob, so that nothing is
/// symmetric.
inline Points knobbedBox(const Eigen::Vector3d& half, const Eigen::Vector3d& knob, int num_points, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(3, num_points);
  const Eigen::Vector3d areas(half.y() * half.z(), half.z() * half.x(), half.x() * half.y());
  for (int i = 0; i < num_points; ++i) {
    Eigen::Vector3d x;
    if (i % 10 == 0) {
      for (int k = 0; k < 3; ++k) x[k] = knob[k] + 0.1 * (random.uniform() - 0.5);
    } else {
      double share = random.uniform() * areas.sum();
      int axis = 0;
      while (axis < 2 && share >= areas[axis]) share -= areas[axis++];
      for (int k = 0; k < 3; ++k) x[k] = half[k] * (2.0 * random.uniform() - 1.0);
      x[axis] = random.uniform() < 0.5 ? -half[axis] : half[axis];
    }
    points.col(i) = x.cast<float>();
  }
  return points;
}

}  // namespace pcl_symmetry::test
