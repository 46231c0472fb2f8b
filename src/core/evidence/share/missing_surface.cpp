#include "core/evidence/share/missing_surface.h"

#include <algorithm>
#include <numeric>

#include "core/normals/open_borders.h"

namespace pcl_symmetry {

namespace {

// Explained share of a region's edge from which its samples begin to count as missing, and from which they count in
// full. chosen: lower bounds excuse what is asymmetric; higher bounds lose cuts with ragged borders.
constexpr float kLeastExplained = 0.5f, kExplained = 0.9f;

/// Regions of samples that are joined as neighbours.
class Regions {
public:
  explicit Regions(std::size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0); }

  int of(int i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }

  void join(int i, int j) { parents_[of(i)] = of(j); }

private:
  std::vector<int> parents_;
};

}  // namespace

std::vector<float> missingCounterparts(const std::vector<char>& matched, const std::vector<int>& closest,
                                       const LocalGeometry& geometry, const std::vector<char>& borders) {
  const std::size_t size = matched.size();
  const std::vector<char> near = nearBorders(borders, geometry);
  const auto ends = [&](int i) { return near[i] || (closest[i] >= 0 && near[closest[i]]); };
  Regions regions(size);
  for (std::size_t i = 0; i < size; ++i)
    for (const int j : geometry.nearest[i])
      if (!matched[i] && !matched[j]) regions.join(static_cast<int>(i), j);
  std::vector<float> edges(size, 0.0f), explained(size, 0.0f);  // of the region with this root
  for (std::size_t i = 0; i < size; ++i) {
    for (const int j : geometry.nearest[i]) {
      if (matched[i] == matched[j]) continue;
      const int region = regions.of(matched[i] ? j : static_cast<int>(i));
      edges[region] += 1.0f;
      explained[region] += ends(static_cast<int>(i)) || ends(j) ? 1.0f : 0.0f;
    }
  }
  std::vector<float> missing(size, 0.0f);
  for (std::size_t i = 0; i < size; ++i) {
    if (matched[i]) continue;
    const int region = regions.of(static_cast<int>(i));
    const float share = edges[region] > 0.0f ? explained[region] / edges[region] : 0.0f;
    missing[i] = std::clamp((share - kLeastExplained) / (kExplained - kLeastExplained), 0.0f, 1.0f);
  }
  return missing;
}

}  // namespace pcl_symmetry
