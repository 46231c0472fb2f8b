#include "core/segmentation/region_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/statistics.h"
#include "core/segmentation/labels.h"
#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

double ratio(double a, double b) {
  return b > 0.0 ? a / b : 0.0;
}

/// Logarithm of the thickness at each patch. A patch behind which no ray met another side is open: as thick as the
/// thickest one.
std::vector<double> logThickness(const std::vector<double>& thickness) {
  const double thickest = *std::max_element(thickness.begin(), thickness.end());
  std::vector<double> log_thickness;
  for (const double t : thickness)
    log_thickness.push_back(std::log(std::max(kSegmentation.thinnest, t > 0.0 ? t : thickest)));
  return log_thickness;
}

}  // namespace

void Regions::Border::operator+=(const Border& other) {
  length += other.length;
  edge_concavity += other.edge_concavity;
  patch_concavity += other.patch_concavity;
  log_thickness += other.log_thickness;
}

Regions::Regions(const PartEvidence& evidence)
    : region_(evidence.patches.areas.size()),
      areas_(evidence.patches.areas),
      log_thickness_(evidence.patches.areas.size()),
      perimeters_(evidence.patches.areas.size(), 0.0),
      inside_(evidence.patches.areas.size()),
      borders_(evidence.patches.areas.size()) {
  const int size = evidence.size();
  const std::vector<double> log_thickness = logThickness(evidence.thickness);
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
    perimeters_[b.from] += b.length;
    perimeters_[b.to] += b.length;
    borders_.add(b.from, b.to,
                 {b.length, b.length * b.edge_concavity, b.length * b.patch_concavity,
                  b.length * 0.5 * (log_thickness[b.from] + log_thickness[b.to])});
  }
}

/// The region that holds most of the reflection of a region; -1 for none.
int Regions::imageOf(int region, const Eigen::MatrixXf& shared) const {
  Eigen::Index most = 0;
  return shared.col(region).maxCoeff(&most) > 0.0f ? static_cast<int>(most) : -1;
}

Cues Regions::cues(int a, int b) const {
  const Border& between = borders(a).at(b);
  const double area_a = std::max(kSegmentation.min_area, areas_[a]),
               area_b = std::max(kSegmentation.min_area, areas_[b]);
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
  for (const Eigen::MatrixXf& shared : images_)
    if (imageOf(a, shared) == b && imageOf(b, shared) == a) cues[kImages] = 1.0;
  cues[kEdgeConcavity] = ratio(between.edge_concavity, between.length);
  cues[kPatchConcavity] = ratio(between.patch_concavity, between.length);
  cues[kInnerConcavity] =
      ratio(inside_[a].patch_concavity + inside_[b].patch_concavity, inside_[a].length + inside_[b].length);
  const double thickness_a = log_thickness_[a] / area_a, thickness_b = log_thickness_[b] / area_b;
  cues[kThicknessRatio] = std::abs(thickness_a - thickness_b);
  cues[kConstriction] = std::min(thickness_a, thickness_b) - ratio(between.log_thickness, between.length);
  const double within = std::sqrt(sight_(a, a) * sight_(b, b)) / (area_a * area_b);
  cues[kSight] = sight_(a, b) / (area_a * area_b);
  cues[kRelativeSight] =
      std::min(kSegmentation.max_relative_sight, cues[kSight] / std::max(kSegmentation.min_inner_sight, within));
  cues[kSightOfSmall] = cues[kSight] * cues[kSmallArea];
  return cues;
}

void Regions::merge(int a, int b) {
  inside_[a] += inside_[b];
  perimeters_[a] += perimeters_[b];
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
  const Border between = borders_.join(a, b);
  inside_[a] += between;
  perimeters_[a] -= 2.0 * between.length;
}

std::vector<Merge> mergeRegions(Regions regions, const MergeWeights& weights) {
  // log odds that two regions are one part: a weighted sum of the cues
  std::map<std::pair<int, int>, double> log_odds;  // by the regions, the lower number first
  const auto update = [&](int a, int b) {
    const Cues cues = regions.cues(a, b);
    log_odds[std::minmax(a, b)] = std::inner_product(weights.begin(), weights.end(), cues.begin(), 0.0);
  };
  for (int a = 0; a < regions.size(); ++a)
    for (const auto& [b, border] : regions.borders(a))
      if (a < b) update(a, b);

  std::vector<Merge> merges;
  while (!log_odds.empty()) {
    const auto likeliest = std::max_element(log_odds.begin(), log_odds.end(), [](const auto& p, const auto& q) {
      return std::make_pair(p.second, p.first) < std::make_pair(q.second, q.first);
    });
    const auto [a, b] = likeliest->first;
    merges.push_back({a, b, likeliest->second});
    for (const auto& [c, border] : regions.borders(b)) log_odds.erase(std::minmax(b, c));
    regions.merge(a, b);
    for (const auto& [c, border] : regions.borders(a)) update(a, c);
  }
  return merges;
}

MergedDivision mergedDivision(const PartEvidence& evidence, const MergeWeights& weights, int num_parts) {
  Regions regions(evidence);
  const std::vector<Merge> merges = mergeRegions(regions, weights);
  // The first merge that is uncertain or leaves fewer regions than requested.
  const std::size_t num_made = std::min<std::size_t>(merges.size(), std::max(0, evidence.size() - num_parts));
  std::size_t doubt = 0;
  for (; doubt < num_made && (num_parts > 0 || merges[doubt].log_odds >= kSegmentation.surely_one); ++doubt)
    regions.merge(merges[doubt].into, merges[doubt].from);
  const std::vector<int> cell_of_patch = renumbered(regions.ofPatches());
  MergedDivision division;
  for (const int patch : evidence.patches.of_element) division.cell.push_back(cell_of_patch[patch]);
  std::map<int, std::vector<int>> cells_of;  // cells of each region
  for (int patch = 0; patch < evidence.size(); ++patch) cells_of[regions.ofPatches()[patch]] = {cell_of_patch[patch]};
  const auto size = static_cast<Eigen::Index>(cells_of.size());
  division.probability = Eigen::MatrixXf::Identity(size, size);
  if (num_parts > 0) return division;
  float least = 1.0f;
  for (std::size_t i = doubt; i < merges.size(); ++i) {
    least = std::min(least, static_cast<float>(logistic(merges[i].log_odds)));
    std::vector<int>&into = cells_of[merges[i].into], &from = cells_of[merges[i].from];
    for (const int a : into)
      for (const int b : from) division.probability(a, b) = division.probability(b, a) = least;
    into.insert(into.end(), from.begin(), from.end());
  }
  return division;
}

MergedDivision reflectedDivision(const MergedDivision& division, const std::vector<int>& reflected) {
  MergedDivision result{{}, division.probability};
  for (const int element : reflected) result.cell.push_back(division.cell[element]);
  return result;
}

}  // namespace pcl_symmetry
