#pragma once

#include <cstddef>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

/// A rotation about an axis, and what it counts in D_n of each fold. Rotations by an angle and by its negative
/// correlate equally; what they move into free space differs.
struct AxialRotation {
  double angle;                 ///< radians, in (0, 2 pi)
  std::vector<double> weights;  ///< for each fold; over all rotations they sum to 1
};

/// The rotations that the D of all folds are made of, each once.
/// \param folds as in AxialTransformOptions.
/// \param both_ways also rotations by more than pi.
inline std::vector<AxialRotation> rotationsOf(const std::vector<int>& folds, bool both_ways) {
  const int num_rotations = kTransform.num_rotations;
  std::map<std::pair<int, int>, std::size_t> index_of;  // by reduced fraction of a full rotation
  std::vector<AxialRotation> rotations;
  const auto add = [&](int part, int whole, std::size_t fold, double weight) {
    const int divisor = std::gcd(part, whole);
    const auto [position, is_new] = index_of.try_emplace({part / divisor, whole / divisor}, rotations.size());
    if (is_new) rotations.push_back({2.0 * kPi * part / whole, std::vector<double>(folds.size(), 0.0)});
    rotations[position->second].weights[fold] += weight;
  };
  const auto addPair = [&](int part, int whole, std::size_t fold, double weight) {
    const bool alone = 2 * part == whole;
    add(part, whole, fold, alone || both_ways ? weight : 2.0 * weight);
    if (both_ways && !alone) add(whole - part, whole, fold, weight);
  };
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const int n = folds[i];
    for (int k = 1; 2 * k <= n; ++k) addPair(k, n, i, 1.0 / (n - 1));
    // The middles of equal parts of a half rotation: the mean over all angles but for harmonics of 2 num_rotations and
    // more.
    for (int k = 0; n == 0 && k < num_rotations; ++k) addPair(2 * k + 1, 4 * num_rotations, i, 0.5 / num_rotations);
  }
  return rotations;
}

}  // namespace pcl_symmetry
