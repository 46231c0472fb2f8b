#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numeric>
#include <vector>

namespace pcl_symmetry {

/// Removes the entries for which a predicate holds.
template <typename List, typename Predicate>
void eraseIf(List& list, const Predicate& is_out) {
  list.erase(std::remove_if(list.begin(), list.end(), is_out), list.end());
}

/// Moves the entries of another list to the end of a list.
template <typename List>
void append(List& list, List more) {
  std::move(more.begin(), more.end(), std::back_inserter(list));
}

/// Sorts entries by a member or function in descending order; the sort is stable.
template <typename List, typename Value>
void sortDescending(List& list, const Value& value) {
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto& a, const auto& b) { return std::invoke(value, a) > std::invoke(value, b); });
}

/// Sorts entries by a member or function in ascending order; the sort is stable.
template <typename List, typename Value>
void sortAscending(List& list, const Value& value) {
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto& a, const auto& b) { return std::invoke(value, a) < std::invoke(value, b); });
}

/// \return 0, 1, ..., size - 1.
inline std::vector<int> allIndices(std::ptrdiff_t size) {
  std::vector<int> all(size);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// \return the indices that sort the values in descending order; stable.
template <typename Values>
std::vector<int> descendingOrder(const Values& values) {
  std::vector<int> order = allIndices(static_cast<std::ptrdiff_t>(values.size()));
  sortDescending(order, [&](int i) { return values[i]; });
  return order;
}

}  // namespace pcl_symmetry
