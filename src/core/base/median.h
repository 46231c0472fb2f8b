#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl_symmetry {

/// The upper median: with an even number of values, the greater of the two in the middle.
/// \param values at least one.
template <typename T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace pcl_symmetry
