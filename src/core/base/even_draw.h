#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/random.h"

namespace pcl_symmetry {

/// Draws one of each of \p num_drawn equal runs of a sequence.
/// \param size length of the sequence, more than \p num_drawn.
/// \return num_drawn positions in the sequence, rising.
inline std::vector<std::size_t> oneOfEachRun(std::size_t size, std::size_t num_drawn, std::uint64_t seed) {
  std::vector<std::size_t> drawn(num_drawn);
  RandomStream random(seed);
  const double run = static_cast<double>(size) / static_cast<double>(num_drawn);
  std::size_t next = 0;
  for (std::size_t i = 0; i < num_drawn; ++i) {
    const double position = (static_cast<double>(i) + random.uniform()) * run;
    drawn[i] = std::max(next, std::min(size - 1, static_cast<std::size_t>(position)));
    next = drawn[i] + 1;
  }
  return drawn;
}

}  // namespace pcl_symmetry
