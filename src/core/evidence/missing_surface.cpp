#include "core/evidence/missing_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/evidence/surface_end.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/open_borders.h"

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
// Share of the surface, and samples, from which a region may be a piece whose counterpart was cut off. chosen: less
// decides nothing, and its reflection fixes no plane.
constexpr double kLeastPiece = 0.002;
constexpr std::size_t kLeastOfPiece = 8;
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

/// The samples of each region, those of the smallest index first.
std::vector<std::vector<int>> membersOf(Regions& regions, const std::vector<char>& matched) {
  std::vector<std::vector<int>> members;
  std::vector<int> number(matched.size(), -1);
  for (std::size_t i = 0; i < matched.size(); ++i) {
    if (matched[i]) continue;
    int& of_root = number[regions.of(static_cast<int>(i))];
    if (of_root < 0) {
      of_root = static_cast<int>(members.size());
      members.emplace_back();
    }
    members[of_root].push_back(static_cast<int>(i));
  }
  return members;
}

}  // namespace

std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected) {
  const std::size_t size = matched.size();
  const auto& nearest = surface.geometry.nearest;
  const std::vector<char> near = nearBorders(surface.borders, surface.geometry);
  const auto ends = [&](int i) { return near[i] || (closest[i] >= 0 && near[closest[i]]); };
  Regions regions(size);
  for (std::size_t i = 0; i < size; ++i)
    for (const int j : nearest[i])
      if (!matched[i] && !matched[j]) regions.join(static_cast<int>(i), j);
  std::vector<float> edges(size, 0.0f), explained(size, 0.0f);  // of the region with this root
  for (std::size_t i = 0; i < size; ++i) {
    for (const int j : nearest[i]) {
      if (matched[i] == matched[j]) continue;
      const int region = regions.of(matched[i] ? j : static_cast<int>(i));
      edges[region] += 1.0f;
      explained[region] += ends(static_cast<int>(i)) || ends(j) ? 1.0f : 0.0f;
    }
  }
  const auto least = std::max(kLeastOfPiece, static_cast<std::size_t>(kLeastPiece * static_cast<double>(size)));
  std::vector<float> missing(size, 0.0f);
  for (const std::vector<int>& members : membersOf(regions, matched)) {
    const int region = regions.of(members.front());
    float value = 0.0f;
    if (edges[region] > 0.0f) {
      const auto at_borders = std::count_if(members.begin(), members.end(), [&](int i) { return near[i] != 0; });
      // A region all of which lies near borders, as a wire, has its edge near them whatever the plane.
      const float chance = std::min(kMostByChance, static_cast<float>(at_borders) / static_cast<float>(members.size()));
      const float share = (lowerLimit(explained[region], edges[region]) - chance) / (1.0f - chance);
      value = std::clamp((share - kLeastExplained) / (kExplained - kLeastExplained), 0.0f, 1.0f);
    }
    if (value < 1.0f && members.size() >= least)
      value = std::max(value, beyondEnd(surface.points, surface.geometry.normals,
                                        OutermostPoints(pointsAt(reflected, members)), surface.spacing));
    for (const int i : members) missing[i] = value;
  }
  return missing;
}

}  // namespace pcl_symmetry
