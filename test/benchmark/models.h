/// Shapes that the benchmarks run on.
#pragma once

#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::benchmarks {

/// A surface that points can be sampled from.
struct Model {
  std::string name;
  Points vertices;
  std::vector<Eigen::Vector3i> triangles;

  Points sample(int num_points) const;
  /// What is seen of that many samples from the viewpoint: the nearest one in each pixel.
  Points scan(int num_points, const Eigen::Vector3d& viewpoint) const;
};

/// bull, cow, elephant, hand and camel .off of CGAL's demo data in the folder PCL_SYMMETRY_MODELS of the environment,
/// or five synthetic shapes. The second one has one plane.
/// \throws std::runtime_error naming the file that cannot be read.
const std::vector<Model>& models();

}  // namespace pcl_symmetry::benchmarks
