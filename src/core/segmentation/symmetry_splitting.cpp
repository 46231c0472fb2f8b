#include "core/segmentation/symmetry_splitting.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/point_samples.h"
#include "core/segmentation/labels.h"
#include "core/segmentation/part_evidence.h"
#include "core/segmentation/segment_borders.h"
#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

/// Draws the first center with a probability proportional to weight, each following one proportional to weight times
/// squared distance from the closest center so far.
Eigen::MatrixXf spreadCenters(const Eigen::MatrixXf& features, const std::vector<float>& weights, int num_clusters,
                              RandomStream& random) {
  const Eigen::Index size = features.cols();
  Eigen::MatrixXf centers(features.rows(), 0);
  Eigen::VectorXd chance = Eigen::Map<const Eigen::VectorXf>(weights.data(), size).cast<double>();
  Eigen::VectorXf sq_distance = Eigen::VectorXf::Constant(size, std::numeric_limits<float>::infinity());
  while (centers.cols() < num_clusters && chance.sum() > 0.0) {
    double rest = random.uniform() * chance.sum();
    Eigen::Index chosen = 0;
    while (chosen + 1 < size && (rest -= chance[chosen]) >= 0.0) ++chosen;
    while (chance[chosen] <= 0.0) --chosen;  // rounding can end the walk at a feature of probability 0
    centers.conservativeResize(Eigen::NoChange, centers.cols() + 1);
    centers.rightCols(1) = features.col(chosen);
    sq_distance = sq_distance.cwiseMin((features.colwise() - features.col(chosen)).colwise().squaredNorm().transpose());
    for (Eigen::Index i = 0; i < size; ++i) chance[i] = static_cast<double>(weights[i]) * sq_distance[i];
  }
  return centers;
}

/// Assigns every feature to its closest center.
/// \return whether a label changed.
bool assign(const Eigen::MatrixXf& features, const std::vector<float>& weights, Clusters& clusters) {
  checkCancelled();
  bool changed = false;
  clusters.sq_error = 0.0;
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    Eigen::Index closest = 0;
    const float sq_distance = (clusters.centers.colwise() - features.col(i)).colwise().squaredNorm().minCoeff(&closest);
    clusters.sq_error += static_cast<double>(weights[i]) * sq_distance;
    changed |= clusters.labels[i] != static_cast<int>(closest);
    clusters.labels[i] = static_cast<int>(closest);
  }
  return changed;
}

/// Moves each center to the weighted mean of its features; a center without features stays.
void moveCenters(const Eigen::MatrixXf& features, const std::vector<float>& weights, Clusters& clusters) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(features.rows(), clusters.centers.cols());
  Eigen::VectorXd totals = Eigen::VectorXd::Zero(clusters.centers.cols());
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    const double weight = weights[i];
    sums.col(clusters.labels[i]) += weight * features.col(i).cast<double>();
    totals[clusters.labels[i]] += weight;
  }
  for (Eigen::Index k = 0; k < totals.size(); ++k)
    if (totals[k] > 0.0) clusters.centers.col(k) = (sums.col(k) / totals[k]).cast<float>();
}

/// The elements of both sides of a split.
struct SplitPart {
  std::vector<int> first, second;
};

/// Splits a part in two by its symmetries (Section 5.3): k-means with k = 2 on the support, the two largest connected
/// components, and the minimum cut between them.
/// \param features features of the part, one column of support per element.
/// \return both sides; nothing if all elements have the same support or one side is empty.
std::optional<SplitPart> splitByTwoMeans(const SurfaceGraph& graph, const std::vector<int>& elements,
                                         const SymmetryFeatures& features, const SplittingOptions& options,
                                         std::uint64_t seed) {
  // "a rough segmentation": two clusters of support
  std::vector<float> areas;
  for (const int element : elements) areas.push_back(graph.areas[element]);
  const Clusters clusters = kMeans(features.support, areas, 2, seed);
  if (clusters.centers.cols() < 2) return std::nullopt;
  std::vector<int> side(graph.size(), -1);
  for (std::size_t i = 0; i < elements.size(); ++i) side[elements[i]] = clusters.labels[i];

  // "the two largest connected components": the cut assigns the smaller ones; as published, they go to the closer of
  // the two
  const std::vector<int> pieces = connectedPieces(graph, side);
  const std::vector<int> largest = descendingOrder(areasOf(graph, pieces));
  if (largest.size() < 2) return std::nullopt;
  const int first = largest[0], second = largest[1];
  std::vector<int> open;
  for (const int element : elements) {
    side[element] = pieces[element] == second ? 1 : 0;
    if (pieces[element] != first && pieces[element] != second) open.push_back(element);
  }
  if (options.as_published) {
    for (const int element : open) side[element] = -1;
    const std::vector<int> closest = filledFromClosest(graph, side);
    for (const int element : open) side[element] = closest[element];
    open.clear();
  }

  // "the exact boundary between them"
  const BorderCutOptions cut{kSegmentation.cut_band * features.radius, options.concavity_weight};
  side = cutBorder(graph, std::move(side), open, cut);
  SplitPart split;
  for (const int element : elements) (side[element] == 0 ? split.first : split.second).push_back(element);
  if (split.first.empty() || split.second.empty()) return std::nullopt;
  return split;
}

/// The splitting rule of Section 5.3: "Segmentation is terminated ... when the only planes of local maxima reflect
/// either more than 90 % or less than 10 % of the surface onto itself". A plane between the two limits continues it.
bool hasDistinctSymmetries(const std::vector<PartPlane>& planes) {
  return std::any_of(planes.begin(), planes.end(), [&](const PartPlane& plane) {
    return plane.share >= kSegmentation.min_share && plane.share <= kSegmentation.max_share;
  });
}

/// A tree of parts that grows by splits of its leaves.
class SplittingTree {
public:
  SplittingTree(const SurfaceGraph& graph, const SegmentationOptions& options) : graph_(graph), options_(options) {
    add(-1, 0, allIndices(graph.size()));
  }

  /// \return the largest leaf that may be split; -1 for none.
  int largestOpen() const {
    int largest = -1;
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
      if (isOpen(i) && areas_[i] > (largest < 0 ? 0.0 : areas_[largest])) largest = i;
    return largest;
  }

  /// Splits a leaf, or closes it if it has no distinct symmetries.
  /// \return whether it was split.
  bool split(int leaf) {
    is_open_[leaf] = false;
    const std::uint64_t seed = options_.seed + leaf;
    const SymmetryFeatures features = symmetryFeatures(graph_, elements_[leaf], options_, seed);
    nodes_[leaf].planes = features.planes;
    if (!hasDistinctSymmetries(features.planes)) return false;
    auto sides = splitByTwoMeans(graph_, elements_[leaf], features, options_.splitting, seed);
    if (!sides) return false;
    const int depth = nodes_[leaf].depth + 1;
    const int first = add(leaf, depth, std::move(sides->first)), second = add(leaf, depth, std::move(sides->second));
    nodes_[leaf].children[0] = first;
    nodes_[leaf].children[1] = second;
    return true;
  }

  /// \return the share of the work that is done, if every open leaf is split down to the depth.
  double progress() const {
    const int depth = options_.splitting.depth;
    double open = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (isOpen(static_cast<int>(i))) open += areas_[i] * std::max(1, depth - nodes_[i].depth);
    return std::clamp(1.0 - open / (graph_.area() * std::max(1, depth)), 0.0, 1.0);
  }

  Segmentation segments() const {
    Segmentation result;
    result.labels.assign(graph_.size(), 0);
    result.tree = nodes_;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].children[0] >= 0) continue;
      result.tree[i].segment = result.num_segments++;
      for (const int element : elements_[i]) result.labels[element] = result.tree[i].segment;
    }
    return numberedByArea(graph_, std::move(result));
  }

private:
  int add(int parent, int depth, std::vector<int> elements) {
    SegmentNode node;
    node.parent = parent;
    node.depth = depth;
    nodes_.push_back(node);
    double area = 0.0;
    for (const int element : elements) area += graph_.areas[element];
    areas_.push_back(area);
    is_open_.push_back(area > 0.0);
    elements_.push_back(std::move(elements));
    return static_cast<int>(nodes_.size()) - 1;
  }

  /// Whether a leaf may still be split; a given number of parts overrules the depth.
  bool isOpen(int node) const {
    return is_open_[node] && (options_.num_parts > 0 || nodes_[node].depth < options_.splitting.depth);
  }

  const SurfaceGraph& graph_;
  const SegmentationOptions& options_;
  std::vector<SegmentNode> nodes_;
  std::vector<std::vector<int>> elements_;  ///< elements of each node
  std::vector<double> areas_;               ///< area of each node, input units squared
  std::vector<bool> is_open_;               ///< leaves not yet tried
};

}  // namespace

Clusters kMeans(const Eigen::MatrixXf& features, const std::vector<float>& weights, int num_clusters,
                std::uint64_t seed) {
  constexpr int num_tries = 4, max_iterations = 100;
  Clusters best;
  for (int attempt = 0; attempt < num_tries; ++attempt) {
    RandomStream random(seed, attempt);
    Clusters clusters;
    clusters.labels.assign(features.cols(), -1);
    clusters.centers = spreadCenters(features, weights, num_clusters, random);
    for (int i = 0; i < max_iterations && assign(features, weights, clusters); ++i)
      moveCenters(features, weights, clusters);
    if (attempt == 0 || clusters.sq_error < best.sq_error) best = std::move(clusters);
  }
  return best;
}

Segmentation segmentBySplitting(const SurfaceGraph& graph, const SegmentationOptions& options) {
  SplittingTree tree(graph, options);
  int num_parts = 1;
  for (int leaf; (leaf = tree.largestOpen()) >= 0 && (options.num_parts == 0 || num_parts < options.num_parts);) {
    if (tree.split(leaf)) ++num_parts;
    if (options.progress) options.progress(tree.progress());
  }
  return tree.segments();
}

}  // namespace pcl_symmetry
