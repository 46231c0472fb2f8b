#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry {

/// Directions spread evenly over the sphere, on a spiral (Fibonacci lattice).
/// \param num_directions >= 1. \return unit vectors, z falling.
/// \throws std::invalid_argument for less than one direction.
std::vector<Eigen::Vector3d> evenDirections(int num_directions);

}  // namespace pcl_symmetry
