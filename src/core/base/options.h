#pragma once

#include <cstdint>

namespace pcl_symmetry {

/// \return default options with a seed and a number of threads.
template <typename Options>
Options optionsWith(std::uint64_t seed, int num_threads) {
  Options options;
  options.seed = seed;
  options.num_threads = num_threads;
  return options;
}

}  // namespace pcl_symmetry
