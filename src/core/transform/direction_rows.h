#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The values of a map along r for each of its directions, strongest direction first: the map back from planes or lines
/// to points (Figures 1 and 2).
class DirectionRows {
public:
  /// \param values rows of num_radius values of D, one for each direction.
  /// \param normals unit vectors, one for each direction.
  /// \param num_radius bins of r.
  /// \param radius of the grid, input units: r is in [-radius, radius].
  DirectionRows(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals, int num_radius,
                double radius);

  /// \param points 3 x N, relative to the center of the grid, input units.
  /// \param num_threads 0 = one per core; the values do not depend on it.
  /// \return the greatest value of any direction through each point, at least 0.
  std::vector<float> greatestThrough(const Points& points, int num_threads) const;

  /// A direction and its values, two bins of 0 before the first and beyond the last.
  struct Row {
    Eigen::Vector3f normal;
    float greatest;
    std::vector<float> values;
  };
  /// Place of a point in a row: n.x * scale + shift, clamped to [0, last].
  struct Place {
    float shift, scale, last;
  };

private:
  Place place_;
  std::vector<Row> rows_;
};

}  // namespace pcl_symmetry
