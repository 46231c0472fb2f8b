#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Directions with their values, the largest first: those that can no longer raise anything are left out at the end.
struct DirectionRows {
  float shift, scale, last;  // as raise() wants them
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> greatest;
  std::vector<std::vector<float>> rows;

  /// \param values num_directions rows of num_radius values of D. \param radius of the grid, input units.
  /// \param normal of each direction, by its index in the values.
  DirectionRows(const std::vector<float>& values, std::size_t num_directions, int num_radius, double radius,
                const std::function<Eigen::Vector3f(std::size_t)>& normal);
};

/// The greatest value of any plane through each point.
/// \param points 3 x N relative to the center of the grid. \return one value per point.
std::vector<float> greatestThrough(const DirectionRows& directions, const Points& points, int num_threads);

}  // namespace pcl_symmetry
