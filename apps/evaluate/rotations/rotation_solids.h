/// Bodies whose groups of rotations people know, for the bench of rotations.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry::apps {

/// A body of triangles, with the group that people see in it at the default tolerance.
struct RotationSolid {
  std::string name;
  std::string kind;  ///< of bodies, such as rims
  /// Whether the constants of the library were chosen on bodies of this kind; results on the others are a report.
  bool chosen_on = false;
  std::string group;  ///< as nameOf() has it
  std::vector<Eigen::Vector3d> vertices = {};
  std::vector<Eigen::Vector3i> triangles = {};

  /// Points spread evenly over the surface, in a random pose.
  /// \param noise standard deviation of each coordinate, share of the diameter.
  Points sampled(int num_points, std::uint64_t seed, double noise) const;
};

/// All bodies, those that the constants were chosen on first.
std::vector<RotationSolid> rotationSolids();

}  // namespace pcl_symmetry::apps
