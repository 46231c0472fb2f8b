#include "core/evidence/share/missing_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/normals/open_borders.h"

namespace pcl_symmetry {

namespace {

// Explained share of a region's edge, beyond chance, from which its samples begin to count as missing, and from which
// they count in full. chosen: among these, 0.45 and 0.8, and 0.5 and 0.9 by cross-validation over the models of fold 0:
// 207, 203 and 199 of 249 symmetric clouds cut by 20 % are decided right, 6, 6 and 3 of 248 asymmetric whole ones
// called.
constexpr float kLeastExplained = 0.4f, kExplained = 0.75f;
// Standard errors by which the explained share of an edge may be more than that of longer edges of its kind. derived:
// 97.5 % of a normal distribution are below. Edges of ten pairs are explained by chance too often.
constexpr float kStandardErrors = 1.96f;
constexpr float kMostByChance = 0.99f;  // chosen: any share near 1; avoids a division by 0

/// Lower limit of a proportion (Wilson).
float lowerLimit(float count, float total) {
  const float share = count / total, sq = kStandardErrors * kStandardErrors / total;
  return (share + 0.5f * sq - std::sqrt(sq * (share * (1.0f - share) + 0.25f * sq))) / (1.0f + sq);
}

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
  std::vector<float> edges(size, 0.0f), explained(size, 0.0f);     // of the region with this root
  std::vector<float> members(size, 0.0f), at_borders(size, 0.0f);  // the same
  for (std::size_t i = 0; i < size; ++i) {
    if (!matched[i]) {
      const int region = regions.of(static_cast<int>(i));
      members[region] += 1.0f;
      at_borders[region] += near[i] ? 1.0f : 0.0f;
    }
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
    if (edges[region] == 0.0f) continue;
    // A region all of which lies near borders, as a wire, has its edge near them whatever the plane.
    const float chance = std::min(kMostByChance, at_borders[region] / members[region]);
    const float share = (lowerLimit(explained[region], edges[region]) - chance) / (1.0f - chance);
    missing[i] = std::clamp((share - kLeastExplained) / (kExplained - kLeastExplained), 0.0f, 1.0f);
  }
  return missing;
}

}  // namespace pcl_symmetry
