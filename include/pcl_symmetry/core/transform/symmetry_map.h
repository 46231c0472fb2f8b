#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/transform/plane_grid.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How a map was estimated; all methods give the same normalised quantity.
enum class TransformMethod {
  Sampled,      ///< one point drawn, the other looked up: the default, fastest
  Convolution,  ///< exact correlation along each normal (Section 4.2)
  Voting        ///< Monte Carlo voting of point pairs (Section 4.3): averages over bins, not values at their centers
};

/// The planar-reflective symmetry transform of a shape: D(f, gamma) = f . gamma(f) / |f|^2 for every bin of planes.
struct SymmetryMap {
  PlaneGrid grid;
  /// grid.size() values of D, about [0, 1]; 1 = perfect symmetry.
  std::vector<float> values;
  TransformMethod method = TransformMethod::Sampled;
  /// Width of the GEDT that the map was made with, input units.
  double sigma = 0.0;
  /// Mean of the points, input frame: the point from which the paper measures r in its threshold 1 - r / R.
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();

  /// D at a bin.
  float operator[](std::size_t index) const { return values[index]; }

  /// PRST = sqrt((1 + D) / 2) at a bin (Equation 1).
  double prst(std::size_t index) const { return std::sqrt(std::max(0.0, 0.5 * (1.0 + values[index]))); }

  /// Bin of the largest value; 0 for an empty map.
  std::size_t strongest() const;

  bool empty() const { return values.empty(); }
};

/// The transform mapped back from planes to points (Figures 1 and 2): for each point the greatest D of any plane
/// through it, over the directions of the map and all radii (in between by cubic interpolation). \param points 3 x N,
/// finite, input frame. \return one value per point; 0 where no plane of the map passes.
std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads = 0);

}  // namespace pcl_symmetry
