#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl_symmetry {

/// \param values at least one.
template <typename T>
double mean(const std::vector<T>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The upper median: with an even number of values, the greater of the two in the middle.
/// \param values at least one.
template <typename T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value below which \p share of the values lie.
/// \param values at least one.
/// \param share in [0, 1].
template <typename T>
T quantile(std::vector<T> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// \param values more than twice \p num_cut.
/// \return the least and the greatest value after the \p num_cut least and the \p num_cut greatest are removed.
template <typename T>
std::pair<T, T> trimmedExtent(std::vector<T> values, std::size_t num_cut) {
  const auto low = values.begin() + num_cut;
  const auto high = values.end() - 1 - num_cut;
  std::nth_element(values.begin(), low, values.end());
  const T least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

/// \return the probability that corresponds to log odds.
inline double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// \return the probability after its odds are multiplied by a factor.
inline double withOdds(double probability, double factor) {
  return factor * probability / (1.0 - probability + factor * probability);
}

}  // namespace pcl_symmetry
