#include "core/segmentation/two_means_split.h"

#include <algorithm>
#include <utility>

#include "core/base/k_means.h"
#include "core/segmentation/border_cut.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// k-means with k = 2 on the support of the elements, weighted by area.
Clusters twoMeans(const SurfaceGraph& graph, const std::vector<int>& elements, const Eigen::MatrixXf& support,
                  std::uint64_t seed) {
  std::vector<float> areas;
  for (const int element : elements) areas.push_back(graph.areas[element]);
  KMeansOptions options;
  options.num_clusters = 2;
  options.seed = seed;
  return kMeans(support, areas, options);
}

/// The two pieces with the largest areas; -1 for a missing one.
std::pair<int, int> largestPieces(const SurfaceGraph& graph, const std::vector<int>& pieces) {
  std::vector<double> areas(1 + *std::max_element(pieces.begin(), pieces.end()), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (pieces[i] >= 0) areas[pieces[i]] += graph.areas[i];
  int first = -1, second = -1;
  for (int p = 0; p < static_cast<int>(areas.size()); ++p) {
    if (first < 0 || areas[p] > areas[first]) {
      second = first;
      first = p;
    } else if (second < 0 || areas[p] > areas[second]) {
      second = p;
    }
  }
  return {first, second};
}

/// Gives each element of side -2 the side of the closest element of side 0 or 1.
std::vector<int> sidesOfClosest(const SurfaceGraph& graph, std::vector<int> side) {
  std::vector<int> known, unknown;
  for (std::size_t i = 0; i < side.size(); ++i) {
    if (side[i] >= 0) known.push_back(static_cast<int>(i));
    if (side[i] == -2) unknown.push_back(static_cast<int>(i));
  }
  if (unknown.empty()) return side;
  std::vector<int> closest;
  std::vector<float> sq_distances;
  const Points known_centers = graph.centers(Eigen::all, known);
  makeFlannSearch(known_centers)->search(graph.centers(Eigen::all, unknown), 1, closest, sq_distances);
  for (std::size_t k = 0; k < unknown.size(); ++k) side[unknown[k]] = side[known[closest[k]]];
  return side;
}

}  // namespace

std::optional<SplitPart> splitByTwoMeans(const SurfaceGraph& graph, const std::vector<int>& elements,
                                         const SymmetryFeatures& features, const SplittingOptions& options,
                                         std::uint64_t seed) {
  // "a rough segmentation": two clusters of support
  const Clusters clusters = twoMeans(graph, elements, features.support, seed);
  if (clusters.centers.cols() < 2) return std::nullopt;
  std::vector<int> side(static_cast<std::size_t>(graph.size()), -1);
  for (std::size_t i = 0; i < elements.size(); ++i) side[elements[i]] = clusters.labels[i];

  // "the two largest connected components": the cut assigns the smaller ones; as published, the closer of the two does
  const std::vector<int> pieces = connectedPieces(graph, side);
  const auto [first, second] = largestPieces(graph, pieces);
  if (second < 0) return std::nullopt;
  std::vector<int> open;
  for (const int element : elements) {
    side[element] = pieces[element] == second ? 1 : 0;
    if (pieces[element] != first && pieces[element] != second) open.push_back(element);
  }
  if (options.as_published) {
    for (const int element : open) side[element] = -2;  // of neither, but of the part
    side = sidesOfClosest(graph, std::move(side));
    open.clear();
  }

  // "the exact boundary between them"
  BorderCutOptions cut;
  cut.band = options.cut_band * features.radius;
  cut.concavity_weight = options.concavity_weight;
  side = cutBorder(graph, std::move(side), open, cut);
  SplitPart split;
  for (const int element : elements) (side[element] == 0 ? split.first : split.second).push_back(element);
  if (split.first.empty() || split.second.empty()) return std::nullopt;
  return split;
}

}  // namespace pcl_symmetry
