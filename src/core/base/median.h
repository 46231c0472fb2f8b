#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl_symmetry {

/// The upper median. \param values at least one.
inline double median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace pcl_symmetry
