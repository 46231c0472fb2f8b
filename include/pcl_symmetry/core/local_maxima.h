#pragma once

#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The paper's thresholds on local maxima, each a share of the value at the strongest one (Section 4.4).
struct LocalMaximaOptions {
  double strength = 0.1;   ///< keeps D >= strength * D_strongest * (1 - r / R), in [0, 1]; the paper's 1/10
  double laplacian = 0.1;  ///< keeps -Laplacian >= laplacian * -Laplacian_strongest, in [0, 1]; the paper's 1/10

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A bin higher than all its neighbors.
struct LocalMaximum {
  PlaneGrid::Bin bin;     ///< whose value is the greatest among its neighbors
  ReflectionPlane plane;  ///< at the bin center, input frame
  double value;           ///< D
};

/// Local maxima of the map that pass the thresholds (Section 4.4).
///
/// r is the distance of the plane from the center of mass, R the radius of the grid. The discrete Laplacian is the sum
/// of the second differences along theta, phi and r in steps of the grid. A maximum on a seam of the grid is found
/// once.
/// \param map may be empty.
/// \param num_threads 0 = one per core; the maxima do not depend on it.
/// \return strongest first.
/// \throws std::invalid_argument for bad options.
std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options = {},
                                          int num_threads = 0);

}  // namespace pcl_symmetry
