/// Models of different kinds for tests of the database, and scans of them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "pcl/clouds.h"
#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::test {

using Cloud = SymmetryDatabase::Cloud;

/// A box with a rod on top.
inline Cloud rodOnBox(const Eigen::Vector3d& half, double rod, const Eigen::Isometry3d& pose, std::uint64_t seed) {
  Points points(3, 5000);
  RandomStream random(seed);
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3d x = randomPoint(random);
    if (i % 5 == 0) {
      const double angle = M_PI * symmetric(random);
      x = Eigen::Vector3d(0.1 * std::cos(angle) + 0.5 * half.x(), 0.1 * std::sin(angle),
                          half.z() + rod * random.uniform());
    } else {
      const int axis = i % 3;
      x[axis] = x[axis] < 0.0 ? -1.0 : 1.0;
      x = x.cwiseProduct(half);
    }
    points.col(i) = (pose * x).cast<float>();
  }
  return *toCloud(points);
}

inline Cloud ball() {
  return *toCloud(sphere(5000, 9));
}

/// The points that a scanner there sees.
inline Cloud seenFrom(const Cloud& whole, const Eigen::Vector3f& viewpoint) {
  Cloud cloud = *toCloud(visiblePoints(whole.getMatrixXfMap(3, 4, 0), viewpoint.cast<double>(), 0.1));
  cloud.sensor_origin_ << viewpoint, 1.0f;
  return cloud;
}

struct Kind {
  const char* name;
  Eigen::Vector3d half;
  double rod;
};
inline const Kind kKinds[] = {{"cube", {1.0, 0.95, 0.9}, 0.5},
                              {"plate", {1.0, 0.8, 0.1}, 0.6},
                              {"beam", {1.5, 0.2, 0.3}, 0.3},
                              {"post", {0.3, 0.3, 0.6}, 2.0}};

inline Eigen::Isometry3d elsewhere() {
  return Eigen::Translation3d(4.0, -2.0, 1.0) * Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -1.0, 0.8).normalized());
}

}  // namespace pcl_symmetry::test
