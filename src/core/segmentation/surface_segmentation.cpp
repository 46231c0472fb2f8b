#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/base/check.h"
#include "core/segmentation/border_cut.h"
#include "core/segmentation/part_evidence.h"
#include "core/segmentation/region_merging.h"
#include "core/segmentation/symmetry_splitting.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

double areaOf(const SurfaceGraph& graph, const std::vector<int>& elements) {
  double area = 0.0;
  for (const int element : elements) area += graph.areas[element];
  return area;
}

/// Numbers segments by falling area.
void numberByArea(const SurfaceGraph& graph, Segmentation& segmentation) {
  std::vector<double> areas(static_cast<std::size_t>(segmentation.num_segments), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[segmentation.labels[i]] += graph.areas[i];
  std::vector<int> order(areas.size()), number(areas.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<int>(i);
  for (int& label : segmentation.labels) label = number[label];
  for (SegmentNode& node : segmentation.tree)
    if (node.segment >= 0) node.segment = number[node.segment];
}

/// The paper's recursion, the largest part first.
class Splitting {
public:
  Splitting(const SurfaceGraph& graph, const SegmentationOptions& options) : graph_(graph), options_(options) {}

  Segmentation run() {
    std::vector<int> all(static_cast<std::size_t>(graph_.size()));
    std::iota(all.begin(), all.end(), 0);
    add(-1, 0, std::move(all));
    int num_leaves = 1;
    for (int next; (next = largestOpen()) >= 0 && (options_.num_parts == 0 || num_leaves < options_.num_parts);) {
      open_[next] = false;
      num_leaves += split(next) ? 1 : 0;
      if (options_.progress) options_.progress(progress());
    }
    Segmentation result;
    result.labels.assign(static_cast<std::size_t>(graph_.size()), 0);
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      if (tree_[i].children[0] >= 0) continue;
      tree_[i].segment = result.num_segments++;
      for (const int element : elements_[i]) result.labels[element] = tree_[i].segment;
    }
    result.tree = std::move(tree_);
    numberByArea(graph_, result);
    return result;
  }

private:
  int add(int parent, int depth, std::vector<int> elements) {
    SegmentNode node;
    node.parent = parent;
    node.depth = depth;
    tree_.push_back(node);
    open_.push_back(areaOf(graph_, elements) > 0.0);
    elements_.push_back(std::move(elements));
    return static_cast<int>(tree_.size()) - 1;
  }

  int largestOpen() const {
    int largest = -1;
    double most = 0.0;
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      if (!open_[i] || (options_.num_parts == 0 && tree_[i].depth >= options_.splitting.depth)) continue;
      const double area = areaOf(graph_, elements_[i]);
      if (area <= most) continue;
      largest = static_cast<int>(i);
      most = area;
    }
    return largest;
  }

  bool split(int index) {
    const SplittingOptions& splitting = options_.splitting;
    const SymmetryFeatures features =
        symmetryFeatures(graph_, elements_[index], splitting, options_.seed + index, options_.num_threads);
    tree_[index].planes = features.planes;
    const bool mixed = std::any_of(features.planes.begin(), features.planes.end(), [&](const PartPlane& plane) {
      return plane.share >= splitting.min_share && plane.share <= splitting.max_share;
    });
    if (!mixed) return false;
    auto sides = splitBySymmetry(graph_, elements_[index], features, splitting, options_.seed + index);
    if (!sides) return false;
    const int depth = tree_[index].depth + 1;
    const int first = add(index, depth, std::move(sides->first)), second = add(index, depth, std::move(sides->second));
    tree_[index].children[0] = first;
    tree_[index].children[1] = second;
    return true;
  }

  double progress() const {
    double open = 0.0;
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (open_[i] && (options_.num_parts > 0 || tree_[i].depth < options_.splitting.depth))
        open += areaOf(graph_, elements_[i]) * std::max(1, options_.splitting.depth - tree_[i].depth);
    return std::clamp(1.0 - open / (graph_.area() * std::max(1, options_.splitting.depth)), 0.0, 1.0);
  }

  const SurfaceGraph& graph_;
  const SegmentationOptions& options_;
  std::vector<SegmentNode> tree_;
  std::vector<std::vector<int>> elements_;
  std::vector<bool> open_;
};

/// Regions of patches with the tree of their merges.
class Merging {
public:
  Merging(const SurfaceGraph& graph, const SegmentationOptions& options)
      : graph_(graph), options_(options), evidence_(partEvidence(graph, options)), regions_(evidence_) {}

  Segmentation run() {
    tell(kEvidenceShare);
    MergeSequence sequence = mergeRegions(regions_, options_.merging.evidence);
    const std::size_t num_patches = evidence_.areas.size(), wanted = static_cast<std::size_t>(options_.num_parts);
    std::size_t num_merges = sequence.num_likely;
    if (wanted > 0) num_merges = std::min(sequence.merges.size(), num_patches - std::min(num_patches, wanted));
    for (std::size_t i = 0; i < num_merges; ++i) regions_.merge(sequence.merges[i].into, sequence.merges[i].from);
    if (wanted == 0) {
      joinFragments();
      if (options_.merging.agree_across_planes && agreeAcrossPlane()) joinFragments();
    }
    for (const int patch : evidence_.patch) result_.labels.push_back(regions_.ofPatches()[patch]);
    if (options_.merging.cut_band > 0.0) {
      cutBorders();
      joinCrumbs();
      if (wanted == 0) joinCutAway();
    }
    tell(kMergedShare);
    numberRegions();
    growTree(mergeRegions(regions_, options_.merging.evidence).merges);
    result_.tree[0].planes = evidence_.planes;
    numberByArea(graph_, result_);
    findImages();
    if (options_.merging.agree_across_planes && wanted == 0) copyAcrossPlane();
    tell(1.0);
    return std::move(result_);
  }

private:
  static constexpr double kEvidenceShare = 0.7, kMergedShare = 0.8;  // of the time, about
  static constexpr double kSymmetricShare = 0.95;  // of the surface, mapped by a plane across which labels agree
  static constexpr double kLeastAcross = 0.2;      // of a region, on the smaller side of a plane that it lies across

  void tell(double share) const {
    if (options_.progress) options_.progress(share);
  }

  /// The region that a fragment borders on most, or the closest one where it has no neighbours.
  int hostOf(int fragment) const {
    int host = -1;
    double most = -1.0;
    for (const int other : regions_.neighbours(fragment)) {
      const double contact = regions_.cues(fragment, other)[kContact];
      if (contact > most) {
        host = other;
        most = contact;
      }
    }
    return host >= 0 ? host : closestTo(fragment);
  }

  int closestTo(int region) const {
    const std::vector<int>& of = regions_.ofPatches();
    int closest = -1;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t p = 0; p < of.size(); ++p) {
      if (of[p] != region) continue;
      for (std::size_t q = 0; q < of.size(); ++q) {
        const float distance = (evidence_.centers.col(p) - evidence_.centers.col(q)).squaredNorm();
        if (of[q] == region || distance >= least) continue;
        closest = of[q];
        least = distance;
      }
    }
    return closest;
  }

  void joinFragments() {
    for (;;) {
      int smallest = -1;
      for (int r = 0; r < regions_.size(); ++r)
        if (regions_.exists(r) && (smallest < 0 || regions_.area(r) < regions_.area(smallest))) smallest = r;
      if (regions_.area(smallest) >= options_.merging.least_area) return;
      const int host = hostOf(smallest);
      if (host < 0) return;
      regions_.merge(host, smallest);
    }
  }

  /// The strongest plane that maps nearly all of the surface onto itself, and its place in PartEvidence::images.
  std::optional<std::pair<ReflectionPlane, std::size_t>> planeOfSymmetry() const {
    std::size_t mapped = 0;
    for (const PartPlane& plane : evidence_.planes) {
      if (plane.share < kMappedShare) continue;
      if (plane.share >= kSymmetricShare) return std::make_pair(plane.plane, mapped);
      ++mapped;
    }
    return std::nullopt;
  }

  /// Makes the regions on one side of the plane of symmetry the images of those on the other side: of the side that
  /// changes less that way. Regions that lie across the plane are their own images.
  bool agreeAcrossPlane() {
    const auto symmetry = planeOfSymmetry();
    if (!symmetry) return false;
    const std::vector<int>& image = evidence_.images[symmetry->second];
    const int size = evidence_.size();
    std::vector<char> above;
    for (int p = 0; p < size; ++p)
      above.push_back(symmetry->first.signedDistance(evidence_.centers.col(p).cast<double>()) > 0.0);
    std::vector<double> area_above(static_cast<std::size_t>(size), 0.0);
    for (int p = 0; p < size; ++p)
      if (above[p]) area_above[regions_.ofPatches()[p]] += evidence_.areas[p];
    const auto liesAcross = [&](int region) {
      const double area = regions_.area(region);
      return std::min(area_above[region], area - area_above[region]) >= kLeastAcross * area;
    };
    // Groups of patches: a region by its number, its image by that and the number of patches.
    std::vector<int> groups[2];
    double changed[2] = {0.0, 0.0};
    for (const int copied : {0, 1}) {  // the side that is kept, and copied to the other: below, above
      for (int p = 0; p < size; ++p) {
        const int own = regions_.ofPatches()[p], other = regions_.ofPatches()[image[p]];
        int group = own;
        if (above[p] != copied) {
          group = liesAcross(other) ? other : other + size;
          if (group == other ? own != other : regions_.imageOf(other, symmetry->second) != own)
            changed[copied] += evidence_.areas[p];
        }
        groups[copied].push_back(group);
      }
    }
    const std::vector<int>& kept = groups[changed[0] <= changed[1] ? 0 : 1];
    Regions regions(evidence_);
    std::map<int, int> first;
    for (int p = 0; p < size; ++p) {
      const auto [entry, is_new] = first.emplace(kept[p], p);
      if (!is_new) regions.merge(entry->second, p);
    }
    regions_ = std::move(regions);
    return true;
  }

  /// Element by element: those on one side of the plane of symmetry get the image of the segment of their image.
  void copyAcrossPlane() {
    const auto symmetry = planeOfSymmetry();
    if (!symmetry) return;
    const std::vector<int>& image = result_.images[symmetry->second];
    for (std::size_t s = 0; s < image.size(); ++s)
      if (image[image[s]] != static_cast<int>(s)) return;
    std::vector<int> below;
    for (int i = 0; i < graph_.size(); ++i)
      if (symmetry->first.signedDistance(graph_.centers.col(i).cast<double>()) < 0.0) below.push_back(i);
    Points reflected(3, static_cast<Eigen::Index>(below.size()));
    for (std::size_t k = 0; k < below.size(); ++k)
      reflected.col(static_cast<Eigen::Index>(k)) =
          symmetry->first.reflect(graph_.centers.col(below[k]).cast<double>()).cast<float>();
    std::vector<int> closest;
    std::vector<float> sq_distances;
    makeFlannSearch(graph_.centers)->search(reflected, 1, closest, sq_distances);
    const std::vector<int> labels = result_.labels;
    std::vector<int> copied = labels;
    for (std::size_t k = 0; k < below.size(); ++k) copied[below[k]] = image[labels[closest[k]]];
    std::vector<char> used(image.size(), 0);
    for (const int label : copied) used[label] = 1;
    if (std::find(used.begin(), used.end(), 0) == used.end()) result_.labels = copied;
  }

  /// Regions of which the cuts have left little.
  void joinCutAway() {
    std::vector<double> areas(evidence_.areas.size(), 0.0);
    for (int i = 0; i < graph_.size(); ++i) areas[result_.labels[i]] += graph_.areas[i];
    for (int r = 0; r < regions_.size(); ++r) {
      if (!regions_.exists(r) || areas[r] >= options_.merging.least_area * graph_.area()) continue;
      const int host = hostOf(r);
      if (host < 0) continue;
      regions_.merge(host, r);
      areas[host] += areas[r];
      std::replace(result_.labels.begin(), result_.labels.end(), r, host);
    }
  }

  void numberRegions() {
    number_.assign(evidence_.areas.size(), -1);
    for (int r = 0; r < regions_.size(); ++r)
      if (regions_.exists(r)) number_[r] = result_.num_segments++;
    for (int& label : result_.labels) label = number_[label];
  }

  /// The further merges, backwards: the last one makes the root. Pieces of the surface that nothing joins hang together
  /// at the top.
  void growTree(const std::vector<Merge>& merges) {
    struct Join {
      int left, right;
    };
    std::vector<Join> joins;
    const int num_leaves = result_.num_segments;
    std::vector<int> top(evidence_.areas.size(), -1);  // number of a leaf, or num_leaves + index of a join
    std::vector<int> root(evidence_.areas.size());
    for (std::size_t p = 0; p < root.size(); ++p) root[p] = regions_.ofPatches()[p];
    for (std::size_t r = 0; r < top.size(); ++r) top[r] = number_[r];
    const auto join = [&](int a, int b) {
      if (a == b) return;
      joins.push_back({top[a], top[b]});
      top[a] = num_leaves + static_cast<int>(joins.size()) - 1;
      std::replace(root.begin(), root.end(), b, a);
    };
    for (const Merge& merge : merges) join(root[merge.into], root[merge.from]);
    for (const int r : std::vector<int>(root)) join(root[0], root[static_cast<std::size_t>(r)]);

    // From the root down; every node follows its parent.
    std::vector<std::pair<int, int>> open{{top[root[0]], -1}};
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto [what, parent] = open[i];
      SegmentNode node;
      node.parent = parent;
      const int index = static_cast<int>(result_.tree.size());
      if (parent >= 0) {
        SegmentNode& above = result_.tree[parent];
        node.depth = above.depth + 1;
        above.children[above.children[0] < 0 ? 0 : 1] = index;
      }
      if (what < num_leaves) {
        node.segment = what;
      } else {
        open.emplace_back(joins[what - num_leaves].left, index);
        open.emplace_back(joins[what - num_leaves].right, index);
      }
      result_.tree.push_back(node);
    }
  }

  /// Borders of two segments each, so that they follow concave edges and not patches.
  void cutBorders() {
    std::set<std::pair<int, int>> pairs;
    for (const SurfaceGraph::Edge& edge : graph_.edges) {
      const auto pair = std::minmax(result_.labels[edge.from], result_.labels[edge.to]);
      if (pair.first != pair.second) pairs.insert(pair);
    }
    const double band = options_.merging.cut_band * std::sqrt(graph_.area());
    const bool concave = options_.merging.evidence != MergingEvidence::Symmetry;
    const double concavity_weight = concave ? options_.merging.concavity_weight : 0.0;
    for (const auto& [a, b] : pairs) {
      std::vector<int> side;
      for (const int label : result_.labels) side.push_back(label == a ? 0 : label == b ? 1 : -1);
      cutBorder(graph_, side, {}, band, concavity_weight);
      for (std::size_t i = 0; i < side.size(); ++i)
        if (side[i] >= 0) result_.labels[i] = side[i] == 0 ? a : b;
    }
  }

  /// What the cuts have left apart from the rest of its segment goes to the neighbour with the longest border.
  void joinCrumbs() {
    const std::vector<int> pieces = connectedPieces(graph_, result_.labels);
    std::vector<double> areas(1 + static_cast<std::size_t>(*std::max_element(pieces.begin(), pieces.end())), 0.0);
    std::vector<int> segment_of(areas.size(), 0);
    for (int i = 0; i < graph_.size(); ++i) {
      areas[pieces[i]] += graph_.areas[i];
      segment_of[pieces[i]] = result_.labels[i];
    }
    std::vector<int> largest(evidence_.areas.size(), -1);
    for (std::size_t p = 0; p < areas.size(); ++p) {
      int& of = largest[segment_of[p]];
      if (of < 0 || areas[p] > areas[of]) of = static_cast<int>(p);
    }
    std::vector<std::map<int, double>> contacts(areas.size());
    for (const SurfaceGraph::Edge& edge : graph_.edges) {
      const int a = pieces[edge.from], b = pieces[edge.to];
      if (a == b) continue;
      contacts[a][segment_of[b]] += edge.length;
      contacts[b][segment_of[a]] += edge.length;
    }
    std::vector<int> moved = segment_of;
    const double least = options_.merging.least_area * graph_.area();
    for (std::size_t p = 0; p < areas.size(); ++p) {
      if (largest[segment_of[p]] == static_cast<int>(p) || areas[p] >= least || contacts[p].empty()) continue;
      moved[p] = std::max_element(contacts[p].begin(), contacts[p].end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
                 })->first;
    }
    for (int i = 0; i < graph_.size(); ++i) result_.labels[i] = moved[pieces[i]];
  }

  /// By area, patch by patch: of the image of a segment most lies in its image.
  void findImages() {
    std::vector<int> of_patch(evidence_.areas.size(), 0);
    for (std::size_t i = 0; i < result_.labels.size(); ++i) of_patch[evidence_.patch[i]] = result_.labels[i];
    for (const std::vector<int>& image : evidence_.images) {
      Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(result_.num_segments, result_.num_segments);
      for (std::size_t p = 0; p < image.size(); ++p) shared(of_patch[image[p]], of_patch[p]) += evidence_.areas[p];
      std::vector<int>& of = result_.images.emplace_back();
      for (int s = 0; s < result_.num_segments; ++s) {
        Eigen::Index most = s;
        shared.col(s).maxCoeff(&most);
        of.push_back(static_cast<int>(most));
      }
    }
  }

  const SurfaceGraph& graph_;
  const SegmentationOptions& options_;
  const PartEvidence evidence_;
  Regions regions_;
  std::vector<int> number_;  ///< of the segment of a region
  Segmentation result_;
};

}  // namespace

void SplittingOptions::validate() const {
  check(depth >= 0 && depth <= 30, "depth", depth, "in [0, 30]");
  check(min_share >= 0.0 && min_share <= max_share, "min_share", min_share, "in [0, max_share]");
  check(max_share <= 1.0, "max_share", max_share, "<= 1");
  check(strength >= 0.0 && strength <= 1.0, "strength", strength, "in [0, 1]");
  check(max_planes >= 1, "max_planes", max_planes, ">= 1");
  check(cut_band > 0.0, "cut_band", cut_band, "> 0");
  check(concavity_weight >= 0.0, "concavity_weight", concavity_weight, ">= 0");
}

void MergingOptions::validate() const {
  check(num_patches >= 1, "num_patches", num_patches, ">= 1");
  check(least_area >= 0.0 && least_area < 1.0, "least_area", least_area, "in [0, 1)");
  check(cut_band >= 0.0, "cut_band", cut_band, ">= 0");
  check(concavity_weight >= 0.0, "concavity_weight", concavity_weight, ">= 0");
}

void SegmentationOptions::validate() const {
  merging.validate();
  splitting.validate();
  check(num_parts >= 0, "num_parts", num_parts, ">= 0");
  checkNumThreads(num_threads);
}

Segmentation segmentSurface(const SurfaceGraph& graph, const SegmentationOptions& options) {
  options.validate();
  check(graph.size() > 0 && graph.area() > 0.0, "area of the surface", graph.area(), "> 0");
  return options.method == SegmentationMethod::Splitting ? Splitting(graph, options).run()
                                                         : Merging(graph, options).run();
}

}  // namespace pcl_symmetry
