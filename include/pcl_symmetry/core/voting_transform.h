#pragma once

#include <cstdint>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

struct VotingTransformOptions {
  std::int64_t num_pairs = 2'000'000;  ///< point pairs drawn, >= 1; the paper's figure for 1 % at 64^3
  double near_distance = 4.0;  ///< cells, >= 0: closer pairs are drawn plane first, see below; 0 = the paper as written
  double near_share = 0.2;     ///< share of the pairs that are drawn plane first, in (0, 1)
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Monte Carlo voting (Section 4.3): draws pairs (x, x') with probability f(x) f(x') and votes for the plane between
/// them with weight 1 / (2 d^2 sin theta).
///
/// The weight has infinite variance as d -> 0. Departure from the paper: pairs closer than near_distance do not vote;
/// their share of the integral is drawn the other way round - x by f, a plane uniformly in (theta, phi, r) at less than
/// near_distance / 2 from x, with weight f(x') - where the same change of variables makes the weight bounded. The sum
/// of both is unbiased. \return averages of D over the bins.
SymmetryMap votingTransform(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options = {});

}  // namespace pcl_symmetry
