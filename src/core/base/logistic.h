#pragma once

#include <cmath>

namespace pcl_symmetry {

/// \return the probability of log odds.
inline double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace pcl_symmetry
