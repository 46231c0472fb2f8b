#pragma once

#include <vector>

namespace pcl_symmetry {

/// A turn about an axis, and what it counts in D_n of each fold. Turns by an angle and by its negative correlate
/// equally; what they turn into free space differs.
struct AxialTurn {
  double angle;                 ///< radians, in (0, 2 pi)
  std::vector<double> weights;  ///< for each fold; over all turns they sum to 1
};

/// The turns that the D of all folds are made of, each once.
/// \param folds,num_turns as in AxialTransformOptions.
/// \param both_ways also turns by more than pi.
std::vector<AxialTurn> turnsOf(const std::vector<int>& folds, int num_turns, bool both_ways);

}  // namespace pcl_symmetry
