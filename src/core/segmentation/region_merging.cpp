#include "core/segmentation/region_merging.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace pcl_symmetry {

namespace {

constexpr double kThinnest = 1e-3;  // radii

/// Log odds that two regions are one part, per unit of each cue.
///
/// For each kind of evidence a logistic regression on merges of regions of the Princeton Segmentation Benchmark (ids 1
/// modulo 4), each weighed by the product of the two areas to the power 0.65 to 0.75. What it predicts is the share of
/// the pairs of faces, one in each region, that people put into one segment: merging up to even odds is what the Rand
/// index asks for.
struct Weight {
  Cue cue;
  double symmetry, concavity, all;
};
constexpr Weight kWeights[] = {
    {kAlways, -0.051, 1.14, -2.185},
    {kContact, 0.666, 0.8, 1.153},
    {kSmallArea, -0.193, 0.012, -0.847},
    {kLargeArea, -0.51, -0.729, -0.257},
    {kSupportDifference, -7.032, -5.918, -3.755},
    {kImages, 0.944, 0.327, 0.662},
    {kEdgeConcavity, 0.0, -5.539, -6.209},
    {kPatchConcavity, 0.0, -1.192, -1.25},
    {kInnerConcavity, 0.0, 2.73, 1.599},
    {kThicknessRatio, 0.0, 0.0, -1.045},
    {kConstriction, 0.0, 0.0, 1.553},
    {kSight, 0.0, 0.0, 0.148},
    {kRelativeSight, 0.0, 0.0, 3.469},
    {kSightOfSmall, 0.0, 0.0, 0.744},
};

Cues weightsOf(MergingEvidence kind) {
  Cues weights{};
  for (const Weight& w : kWeights)
    weights[w.cue] = kind == MergingEvidence::Symmetry               ? w.symmetry
                     : kind == MergingEvidence::SymmetryAndConcavity ? w.concavity
                                                                     : w.all;
  return weights;
}

double ratio(double a, double b) {
  return b > 0.0 ? a / b : 0.0;
}

}  // namespace

void Regions::Border::add(const Border& other) {
  length += other.length;
  edge_concavity += other.edge_concavity;
  patch_concavity += other.patch_concavity;
  log_thickness += other.log_thickness;
}

Regions::Regions(const PartEvidence& evidence)
    : exists_(evidence.areas.size(), 1),
      region_(evidence.areas.size()),
      areas_(evidence.areas),
      log_thickness_(evidence.areas.size()),
      perimeters_(evidence.areas.size(), 0.0),
      inside_(evidence.areas.size()),
      neighbours_(evidence.areas.size()) {
  const int size = evidence.size();
  // Where rays find no other side the body is open: as thick as it is anywhere.
  const double thickest = *std::max_element(evidence.thickness.begin(), evidence.thickness.end());
  std::vector<double> log_thickness;
  for (const double t : evidence.thickness)
    log_thickness.push_back(std::log(std::max(kThinnest, t > 0.0 ? t : thickest)));
  Eigen::VectorXf areas(size);
  for (int i = 0; i < size; ++i) {
    region_[i] = i;
    areas[i] = static_cast<float>(areas_[i]);
    log_thickness_[i] = areas_[i] * log_thickness[i];
  }
  sight_ = areas.asDiagonal() * evidence.sight * areas.asDiagonal();
  support_ = evidence.support * areas.asDiagonal();
  for (const std::vector<int>& image : evidence.images) {
    images_.emplace_back(Eigen::MatrixXf::Zero(size, size));
    for (int i = 0; i < size; ++i) images_.back()(image[i], i) = areas[i];
  }
  for (const PatchBorder& b : evidence.borders) {
    neighbours_[b.from].push_back(b.to);
    neighbours_[b.to].push_back(b.from);
    perimeters_[b.from] += b.length;
    perimeters_[b.to] += b.length;
    border(b.from, b.to) = {b.length, b.length * b.edge_concavity, b.length * b.patch_concavity,
                            b.length * 0.5 * (log_thickness[b.from] + log_thickness[b.to])};
  }
}

Cues Regions::cues(int a, int b) const {
  const Border& between = borders_.at(std::minmax(a, b));
  const double area_a = std::max(1e-9, areas_[a]), area_b = std::max(1e-9, areas_[b]);
  Cues cues{};
  cues[kAlways] = 1.0;
  cues[kContact] = std::min(1.0, ratio(between.length, std::min(perimeters_[a], perimeters_[b])));
  cues[kSmallArea] = std::log(std::min(area_a, area_b));
  cues[kLargeArea] = std::log(std::max(area_a, area_b));
  if (support_.rows() > 0) {
    const Eigen::VectorXd difference =
        support_.col(a).cast<double>() / area_a - support_.col(b).cast<double>() / area_b;
    cues[kSupportDifference] = difference.norm() / std::sqrt(static_cast<double>(difference.size()));
  }
  for (std::size_t plane = 0; plane < images_.size(); ++plane)
    if (imageOf(a, plane) == b && imageOf(b, plane) == a) cues[kImages] = 1.0;
  cues[kEdgeConcavity] = ratio(between.edge_concavity, between.length);
  cues[kPatchConcavity] = ratio(between.patch_concavity, between.length);
  cues[kInnerConcavity] =
      ratio(inside_[a].patch_concavity + inside_[b].patch_concavity, inside_[a].length + inside_[b].length);
  const double thickness_a = log_thickness_[a] / area_a, thickness_b = log_thickness_[b] / area_b;
  cues[kThicknessRatio] = std::abs(thickness_a - thickness_b);
  cues[kConstriction] = std::min(thickness_a, thickness_b) - ratio(between.log_thickness, between.length);
  constexpr double kLeastSight = 0.05, kMostRelative = 1.5;
  const double within = std::sqrt(sight_(a, a) * sight_(b, b)) / (area_a * area_b);
  cues[kSight] = sight_(a, b) / (area_a * area_b);
  cues[kRelativeSight] = std::min(kMostRelative, cues[kSight] / std::max(kLeastSight, within));
  cues[kSightOfSmall] = cues[kSight] * cues[kSmallArea];
  return cues;
}

void Regions::merge(int a, int b) {
  const auto shared = borders_.find(std::minmax(a, b));
  inside_[a].add(inside_[b]);
  perimeters_[a] += perimeters_[b];
  if (shared != borders_.end()) {
    inside_[a].add(shared->second);
    perimeters_[a] -= 2.0 * shared->second.length;
    borders_.erase(shared);
  }
  areas_[a] += areas_[b];
  log_thickness_[a] += log_thickness_[b];
  support_.col(a) += support_.col(b);
  const auto join = [&](Eigen::MatrixXf& pairs) {
    pairs.col(a) += pairs.col(b);
    pairs.row(a) += pairs.row(b);
    pairs.row(b).setZero();
  };
  join(sight_);
  for (Eigen::MatrixXf& image : images_) join(image);
  std::replace(region_.begin(), region_.end(), b, a);
  exists_[b] = 0;
  const auto forget = [](std::vector<int>& list, int region) {
    list.erase(std::remove(list.begin(), list.end(), region), list.end());
  };
  forget(neighbours_[a], b);
  for (const int c : neighbours_[b]) {
    if (c == a) continue;
    forget(neighbours_[c], b);
    if (borders_.find(std::minmax(a, c)) == borders_.end()) {
      neighbours_[a].push_back(c);
      neighbours_[c].push_back(a);
    }
    border(a, c).add(border(b, c));
    borders_.erase(std::minmax(b, c));
  }
  neighbours_[b].clear();
}

int Regions::imageOf(int region, std::size_t plane) const {
  Eigen::Index image = 0;
  return images_[plane].col(region).maxCoeff(&image) > 0.0f ? static_cast<int>(image) : -1;
}

MergeSequence mergeRegions(Regions regions, MergingEvidence kind) {
  const Cues weights = weightsOf(kind);
  using Pair = std::pair<int, int>;
  std::set<std::pair<double, Pair>> queue;  // the likeliest last
  std::map<Pair, double> odds;
  const auto forget = [&](const Pair& pair) {
    const auto known = odds.find(pair);
    if (known == odds.end()) return;
    queue.erase({known->second, pair});
    odds.erase(known);
  };
  const auto consider = [&](int a, int b) {
    const Pair pair = std::minmax(a, b);
    forget(pair);
    const Cues cues = regions.cues(a, b);
    double sum = 0.0;
    for (int k = 0; k < kNumCues; ++k) sum += weights[k] * cues[k];
    odds[pair] = sum;
    queue.insert({sum, pair});
  };
  for (int a = 0; a < regions.size(); ++a)
    for (const int b : regions.neighbours(a))
      if (a < b) consider(a, b);

  MergeSequence sequence;
  bool likely = true;
  while (!queue.empty()) {
    const auto [log_odds, pair] = *queue.rbegin();
    likely = likely && log_odds > 0.0;
    if (likely) ++sequence.num_likely;
    const auto [a, b] = pair;
    for (const int c : regions.neighbours(b)) forget(std::minmax(b, c));
    regions.merge(a, b);
    sequence.merges.push_back({a, b});
    for (const int c : regions.neighbours(a)) consider(a, c);
  }
  return sequence;
}

}  // namespace pcl_symmetry
