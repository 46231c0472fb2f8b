#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
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

/// \param values more than twice \p num_cut.
/// \return the least and the greatest value that are left without the \p num_cut least and greatest.
template <typename T>
std::pair<T, T> trimmedExtent(std::vector<T> values, std::size_t num_cut) {
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(num_cut);
  const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(num_cut);
  std::nth_element(values.begin(), low, values.end());
  const T least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

}  // namespace pcl_symmetry
