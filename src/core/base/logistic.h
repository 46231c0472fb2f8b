#pragma once

#include <cmath>

namespace pcl_symmetry {

/// \return the probability of log odds.
inline double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// \return a probability whose odds are multiplied by a factor.
inline double withOdds(double probability, double factor) {
  return factor * probability / (1.0 - probability + factor * probability);
}

}  // namespace pcl_symmetry
