/// Random numbers that are the same on every platform, which the standard library's distributions are not.
#pragma once

#include <cmath>

#include "core/base/constants.h"

namespace pcl_symmetry::apps {

/// Uniform in [0, 1).
/// \param generator of 64 random bits.
template <typename Generator>
double uniform(Generator& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

/// Standard normal by Box and Muller, the same wherever the elementary functions are.
template <typename Generator>
double standardNormal(Generator& generator) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(generator)));
  return radius * std::cos(2.0 * kPi * uniform(generator));
}

}  // namespace pcl_symmetry::apps
