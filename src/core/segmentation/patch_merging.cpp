#include "core/segmentation/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/segmentation/labels.h"
#include "core/segmentation/merge_fit.h"
#include "core/segmentation/part_evidence.h"
#include "core/segmentation/segment_borders.h"
#include "core/segmentation/segmentation_rules.h"
#include "core/segmentation/surface_patches.h"

namespace pcl_symmetry {

namespace {

/// The strongest plane that maps nearly the whole surface onto itself, in which labels have to be symmetric, and the
/// element at the reflection of each element.
struct LabelSymmetry {
  ReflectionPlane plane;
  std::vector<int> reflected;
};

std::optional<LabelSymmetry> symmetricPlane(const WholeEvidence& whole, const SegmentationOptions& options) {
  if (options.num_parts > 0) return std::nullopt;
  for (const PartPlane& plane : whole.planes())
    if (plane.share >= kSegmentation.global_share)
      return LabelSymmetry{plane.plane, reflectedElements(whole.graph(), plane.plane)};
  return std::nullopt;
}

/// Labels whose borders follow the surface instead of the patches and are symmetric in the symmetry plane, without
/// small segments.
std::vector<int> refinedLabels(const SurfaceGraph& graph, std::vector<int> labels,
                               const std::optional<LabelSymmetry>& symmetry, int max_segments,
                               const SegmentationOptions& options) {
  const double crumb = kSegmentation.min_part * graph.area(), min_area = options.num_parts == 0 ? crumb : 0.0;
  labels = joinSmallSegments(graph, std::move(labels), min_area, max_segments);
  const BorderCutOptions cut{kSegmentation.part_cut_band * std::sqrt(graph.area()), kSegmentation.part_concavity};
  labels = joinCrumbs(graph, smoothBorders(graph, std::move(labels), cut), crumb);
  if (symmetry) labels = symmetrizedLabels(graph, labels, symmetry->plane, symmetry->reflected);
  return joinSmallSegments(graph, std::move(labels), min_area, max_segments);
}

/// Binary joins of leaves. A node below num_leaves is a leaf, node num_leaves + i is join i.
struct Joins {
  int num_leaves = 0, root = 0;
  std::vector<std::pair<int, int>> children;  ///< the two children of each join
};

Joins joinsOf(const std::vector<int>& region_of_patch, const std::vector<int>& segment_of_region,
              const std::vector<Merge>& merges) {
  Joins joins;
  joins.num_leaves = 1 + *std::max_element(segment_of_region.begin(), segment_of_region.end());
  std::vector<int> node = segment_of_region;   // topmost node that a region belongs to
  std::vector<int> current = region_of_patch;  // region that each patch belongs to at present
  const auto join = [&](int into, int from) {
    if (into == from) return;
    joins.children.emplace_back(node[into], node[from]);
    node[into] = joins.num_leaves + static_cast<int>(joins.children.size()) - 1;
    std::replace(current.begin(), current.end(), from, into);
  };
  for (const Merge& merge : merges) join(current[merge.into], current[merge.from]);
  for (const int region : std::vector<int>(current)) join(current[0], current[region]);
  joins.root = node[current[0]];
  return joins;
}

/// The tree of segments whose leaves are regions and whose inner nodes are their further merges, the last merge at the
/// root. Regions that no merge connects are joined at the top.
/// \param region_of_patch the region of each patch; regions are numbered as patches.
/// \param segment_of_region number of the segment of each region; -1 for a region that does not exist.
/// \return the root first, children after their parents.
std::vector<SegmentNode> segmentTree(const std::vector<int>& region_of_patch, const std::vector<int>& segment_of_region,
                                     const std::vector<Merge>& merges) {
  const Joins joins = joinsOf(region_of_patch, segment_of_region, merges);
  std::vector<SegmentNode> tree;
  std::vector<std::pair<int, int>> open{{joins.root, -1}};  // nodes with the index of their parent in the tree
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto [join, parent] = open[i];
    const int index = static_cast<int>(tree.size());
    SegmentNode node;
    node.parent = parent;
    if (parent >= 0) {
      SegmentNode& above = tree[parent];
      node.depth = above.depth + 1;
      above.children[above.children[0] < 0 ? 0 : 1] = index;
    }
    if (join < joins.num_leaves) {
      node.segment = join;
    } else {
      const auto [first, second] = joins.children[join - joins.num_leaves];
      open.emplace_back(first, index);
      open.emplace_back(second, index);
    }
    tree.push_back(node);
  }
  return tree;
}

/// A segment for each patch: the one that holds most of it; each segment has at least one patch.
/// \param labels one per element, from 0; at most as many segments as patches.
std::vector<int> segmentsOfPatches(const SurfaceGraph& graph, const Patches& patches, const std::vector<int>& labels) {
  const int num_segments = 1 + *std::max_element(labels.begin(), labels.end());
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(num_segments, patches.size());
  for (int i = 0; i < graph.size(); ++i) shared(labels[i], patches.of_element[i]) += graph.areas[i];
  std::vector<int> segment(patches.size(), -1);
  // The segment whose largest share of a patch is smallest is assigned first.
  const Eigen::VectorXd most = shared.rowwise().maxCoeff();
  for (const int s : descendingOrder(Eigen::VectorXd(-most))) {
    int best = -1;
    for (int p = 0; p < patches.size(); ++p)
      if (segment[p] < 0 && (best < 0 || shared(s, p) > shared(s, best))) best = p;
    if (best >= 0) segment[best] = s;
  }
  for (int p = 0; p < patches.size(); ++p) {
    if (segment[p] >= 0) continue;
    Eigen::Index largest = 0;
    shared.col(p).maxCoeff(&largest);
    segment[p] = static_cast<int>(largest);
  }
  return segment;
}

/// Segments with the tree of their further merges and their images, by the patches of one division.
Segmentation segmentsOf(const SurfaceGraph& graph, const PartEvidence& evidence, std::vector<int> labels,
                        const MergeWeights& weights) {
  Segmentation result;
  result.labels = std::move(labels);
  result.num_segments = 1 + *std::max_element(result.labels.begin(), result.labels.end());
  const std::vector<int> segment_of_patch = segmentsOfPatches(graph, evidence.patches, result.labels);
  std::vector<int> segment_of_region(segment_of_patch.size(), -1), first(segment_of_patch.size(), -1);
  Regions regions(evidence);
  for (int p = 0; p < evidence.size(); ++p) {
    const int segment = segment_of_patch[p];
    if (first[segment] >= 0) {
      regions.merge(first[segment], p);
    } else {
      first[segment] = p;
      segment_of_region[p] = segment;
    }
  }
  result.tree = segmentTree(regions.ofPatches(), segment_of_region, mergeRegions(regions, weights));
  result.tree[0].planes = evidence.planes;
  result = numberedByArea(graph, std::move(result));
  result.images = segmentImages(evidence, result.labels, result.num_segments);
  return result;
}

/// Elements that lie in one cell of every division.
struct CommonCells {
  std::vector<int> of_element;          ///< for each element, its common cell, from 0
  std::vector<double> areas;            ///< share of the surface of each common cell
  std::vector<std::vector<int>> cells;  ///< for each division, its cell that holds each common cell

  int size() const { return static_cast<int>(areas.size()); }
};

/// Numbers the intersections of the divisions.
std::vector<int> intersections(const std::vector<MergedDivision>& divisions) {
  std::vector<int> cell(divisions.front().cell.size(), 0);
  for (const MergedDivision& division : divisions) {
    std::map<std::pair<int, int>, int> number;
    for (std::size_t i = 0; i < cell.size(); ++i)
      cell[i] = number.emplace(std::pair(cell[i], division.cell[i]), static_cast<int>(number.size())).first->second;
  }
  return cell;
}

std::vector<double> areaShares(const SurfaceGraph& graph, const std::vector<int>& label) {
  std::vector<double> areas = areasOf(graph, label);
  const double whole = graph.area();
  for (double& area : areas) area /= whole;
  return areas;
}

CommonCells commonCells(const SurfaceGraph& graph, const std::vector<MergedDivision>& divisions) {
  CommonCells common;
  common.of_element = intersections(divisions);
  const std::vector<double> areas = areaShares(graph, common.of_element);
  const double min_area = std::min(kSegmentation.min_cell, *std::max_element(areas.begin(), areas.end()));
  std::vector<int> number(areas.size(), -1);
  int size = 0;
  for (std::size_t c = 0; c < areas.size(); ++c)
    if (areas[c] >= min_area) number[c] = size++;
  common.cells.assign(divisions.size(), std::vector<int>(static_cast<std::size_t>(size), 0));
  for (std::size_t i = 0; i < common.of_element.size(); ++i) {
    int& cell = common.of_element[i];
    cell = number[cell];
    for (std::size_t d = 0; cell >= 0 && d < divisions.size(); ++d) common.cells[d][cell] = divisions[d].cell[i];
  }
  common.of_element = filledFromClosest(graph, std::move(common.of_element));
  common.areas = areaShares(graph, common.of_element);
  return common;
}

/// Clusters of common cells with the sums of the probabilities of their pairs.
class PatchClusters {
public:
  PatchClusters(const SurfaceGraph& graph, const CommonCells& common, const std::vector<MergedDivision>& divisions)
      : cluster_(allIndices(common.size())),
        areas_(common.areas),
        neighbors_(cluster_.size()),
        sums_(Eigen::MatrixXf::Zero(common.size(), common.size())),
        num_clusters_(common.size()) {
    for (const SurfaceGraph::Edge& edge : graph.edges) {
      const int a = common.of_element[edge.from], b = common.of_element[edge.to];
      if (a != b) neighbors_.add(a, b, 1);
    }
    for (int a = 0; a < common.size(); ++a) {
      for (int b = 0; b < common.size(); ++b) {
        for (std::size_t d = 0; d < divisions.size(); ++d)
          sums_(b, a) += divisions[d].probability(common.cells[d][b], common.cells[d][a]);
        sums_(b, a) *= static_cast<float>(areas_[a] * areas_[b] / static_cast<double>(divisions.size()));
      }
    }
  }

  int size() const { return num_clusters_; }
  const std::vector<int>& ofCells() const { return cluster_; }

  struct Pair {
    int a = -1, b = -1;
    double probability = -1.0;
  };

  /// The two neighbors that most likely are one part; a = -1 if no two clusters are neighbors.
  Pair likeliest() const {
    Pair best;
    for (int a = 0; a < static_cast<int>(areas_.size()); ++a) {
      for (const auto& [b, num_edges] : neighbors_.borders(a)) {
        if (b < a) continue;
        const double area = areas_[a] * areas_[b], mean = area > 0.0 ? sums_(a, b) / area : 1.0;
        if (mean > best.probability) best = {a, b, mean};
      }
    }
    return best;
  }

  void merge(int a, int b) {
    std::replace(cluster_.begin(), cluster_.end(), b, a);
    sums_.col(a) += sums_.col(b);
    sums_.row(a) += sums_.row(b);
    areas_[a] += areas_[b];
    neighbors_.join(a, b);
    --num_clusters_;
  }

private:
  std::vector<int> cluster_;   ///< cluster of each cell
  std::vector<double> areas_;  ///< share of the surface of each cluster
  Adjacency<int> neighbors_;   ///< number of edges between two clusters
  Eigen::MatrixXf sums_;       ///< mean probability of two clusters times both areas
  int num_clusters_;
};

}  // namespace

Segmentation segmentByMerging(const SurfaceGraph& graph, const SegmentationOptions& options) {
  const auto tell = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const WholeEvidence whole(graph, options);
  tell(0.3);
  const MergeWeights& weights = kMergeFit[static_cast<std::size_t>(options.evidence)];
  const std::size_t num_divisions = kSegmentation.num_divisions;
  std::vector<MergedDivision> divisions(num_divisions);
  std::optional<PartEvidence> first;
  parallelBlocks(num_divisions, options.num_threads, [&](std::size_t d) {
    PartEvidence evidence = whole.ofDivision(static_cast<int>(d));
    divisions[d] = mergedDivision(evidence, weights, options.num_parts);
    if (d == 0) first = std::move(evidence);
  });
  tell(0.8);
  const std::optional<LabelSymmetry> symmetry = symmetricPlane(whole, options);
  for (std::size_t d = 0; symmetry && d < num_divisions; ++d)
    divisions.push_back(reflectedDivision(divisions[d], symmetry->reflected));
  std::vector<int> labels =
      refinedLabels(graph, consensus(graph, divisions, options.num_parts), symmetry, first->size(), options);
  Segmentation result = segmentsOf(graph, *first, std::move(labels), weights);
  tell(1.0);
  return result;
}

std::vector<int> consensus(const SurfaceGraph& graph, const std::vector<MergedDivision>& divisions, int num_parts) {
  const CommonCells common = commonCells(graph, divisions);
  PatchClusters clusters(graph, common, divisions);
  while (num_parts == 0 || clusters.size() > num_parts) {
    const PatchClusters::Pair pair = clusters.likeliest();
    if (pair.a < 0 || (num_parts == 0 && pair.probability < 0.5)) break;
    clusters.merge(pair.a, pair.b);
  }
  std::vector<int> part;
  for (const int cell : common.of_element) part.push_back(clusters.ofCells()[cell]);
  return renumbered(std::move(part));
}

}  // namespace pcl_symmetry
