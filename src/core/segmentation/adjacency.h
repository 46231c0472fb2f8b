#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace pcl_symmetry {

/// Sums along the common borders of neighboring regions, while regions join each other.
template <typename Sum>
class Adjacency {
public:
  /// \param size regions have numbers below it.
  explicit Adjacency(std::size_t size) : borders_(size) {}

  /// \return the borders of a region, by neighbor.
  const std::map<int, Sum>& borders(int region) const { return borders_[region]; }

  /// Adds to the border of two regions.
  void add(int a, int b, const Sum& sum) {
    borders_[a][b] += sum;
    borders_[b][a] += sum;
  }

  /// Makes \p b part of \p a; they need not be neighbors.
  /// \return the border between them, which then no longer exists.
  Sum join(int a, int b) {
    Sum between{};
    for (const auto& [c, sum] : std::exchange(borders_[b], {})) {
      borders_[c].erase(b);
      if (c == a)
        between = sum;
      else
        add(a, c, sum);
    }
    return between;
  }

private:
  std::vector<std::map<int, Sum>> borders_;
};

}  // namespace pcl_symmetry
