/// The shape that the benchmarks run on.
#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::benchmarks {

/// A surface that points can be sampled from.
struct Model {
  Points vertices;
  std::vector<Eigen::Vector3i> triangles;

  Points sample(int num_points) const;
  /// What is seen of that many samples from the viewpoint: the nearest one in each pixel.
  Points scan(int num_points, const Eigen::Vector3d& viewpoint) const;
};

/// A body with head, ears and four legs, and one plane.
const Model& animal();

}  // namespace pcl_symmetry::benchmarks
