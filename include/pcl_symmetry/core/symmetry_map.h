#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/plane_grid.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

class GaussianEdt;

/// Estimators of the transform. All give the same normalized quantity.
enum class TransformMethod {
  Sampled,      ///< draws one point of each pair and looks up the other; the default and the fastest
  Convolution,  ///< exact correlation along each normal (Section 4.2, Figure 4a)
  Rotational,   ///< exact correlation of the planes through each of many points (Section 4.2, Figure 4b)
  Voting        ///< Monte Carlo voting of point pairs (Section 4.3); averages over bins instead of values at centers
};

/// The planar-reflective symmetry transform of a shape: D(f, gamma) = f . gamma(f) / |f|^2 (Equation 2) for every bin
/// of planes.
struct SymmetryMap {
  PlaneGrid grid;  ///< the planes of the values
  /// grid.size() values of D, 1 for a perfect symmetry. Estimates exceed [0, 1] by their error.
  std::vector<float> values;
  TransformMethod method = TransformMethod::Sampled;  ///< that made the values
  double sigma = 0.0;                                 ///< width of the GEDT that the map was made from, input units
  /// Mean of the points, input frame. The threshold 1 - r / R of Section 4.4 measures r from it.
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();

  /// \return D at a bin.
  float operator[](std::size_t index) const { return values[index]; }

  /// \return PRST = sqrt((1 + D) / 2) at a bin (Equation 1).
  double prst(std::size_t index) const { return std::sqrt(std::max(0.0, 0.5 * (1.0 + values[index]))); }

  /// \return index of the bin with the greatest value; 0 for an empty map.
  std::size_t strongest() const { return std::max_element(values.begin(), values.end()) - values.begin(); }

  bool empty() const { return values.empty(); }  ///< no transform was computed

  /// \return a map of \p edt whose values are 0, with the center of the grid as center of mass.
  static SymmetryMap zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method);
};

/// The transform mapped back from planes to points (Figures 1 and 2): for each point the greatest D of any plane
/// through it. The planes have the directions of the map and any r, with cubic interpolation between the bins of r.
/// \param points 3 x N, finite, input frame.
/// \param num_threads 0 = one per core; the values do not depend on it.
/// \return one value per point, >= 0; 0 where no plane of the map passes.
std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads = 0);

}  // namespace pcl_symmetry
