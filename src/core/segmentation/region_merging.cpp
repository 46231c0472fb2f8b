#include "core/segmentation/region_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

using RegionPair = std::pair<int, int>;  // lower number first

/// Pairs of neighboring regions, ordered by the log odds that they are one part.
class PairQueue {
public:
  explicit PairQueue(const MergeWeights& weights) : weights_(weights) {}

  bool empty() const { return queue_.empty(); }

  /// \return log odds and regions of the pair with the highest log odds.
  const std::pair<double, RegionPair>& likeliest() const { return *queue_.rbegin(); }

  void remove(int a, int b) {
    const RegionPair pair = std::minmax(a, b);
    const auto known = log_odds_.find(pair);
    if (known == log_odds_.end()) return;
    queue_.erase({known->second, pair});
    log_odds_.erase(known);
  }

  void update(const Regions& regions, int a, int b) {
    remove(a, b);
    const double log_odds = logOdds(regions.cues(a, b));
    log_odds_[std::minmax(a, b)] = log_odds;
    queue_.insert({log_odds, std::minmax(a, b)});
  }

private:
  /// That two regions are one part: a weighted sum of the cues.
  double logOdds(const Cues& cues) const {
    return std::inner_product(weights_.begin(), weights_.end(), cues.begin(), 0.0);
  }

  const MergeWeights& weights_;
  std::set<std::pair<double, RegionPair>> queue_;
  std::map<RegionPair, double> log_odds_;
};

}  // namespace

std::vector<Merge> mergeRegions(Regions regions, const MergeWeights& weights) {
  PairQueue queue(weights);
  for (int a = 0; a < regions.size(); ++a)
    for (const int b : regions.neighbors(a))
      if (a < b) queue.update(regions, a, b);

  std::vector<Merge> merges;
  while (!queue.empty()) {
    const auto [log_odds, pair] = queue.likeliest();
    const auto [a, b] = pair;
    for (const int c : regions.neighbors(b)) queue.remove(b, c);
    regions.merge(a, b);
    merges.push_back({a, b, log_odds});
    for (const int c : regions.neighbors(a)) queue.update(regions, a, c);
  }
  return merges;
}

namespace {

/// The first merge that is not sure, or that leaves fewer regions than asked for.
std::size_t firstDoubt(const std::vector<Merge>& merges, std::size_t num_made) {
  std::size_t i = 0;
  while (i < std::min(merges.size(), num_made) && merges[i].log_odds >= kSegmentation.surely_one) ++i;
  return i;
}

/// Consecutive numbers for the regions of patches.
std::map<int, int> numbersOf(const std::vector<int>& regions) {
  std::map<int, int> number;
  for (const int region : regions) number.emplace(region, static_cast<int>(number.size()));
  return number;
}

}  // namespace

MergedDivision mergedDivision(const PartEvidence& evidence, const MergeWeights& weights, int num_parts) {
  Regions regions(evidence);
  const std::vector<Merge> merges = mergeRegions(regions, weights);
  const auto num_made = static_cast<std::size_t>(std::max(0, evidence.size() - num_parts));
  const std::size_t doubt = num_parts > 0 ? std::min(merges.size(), num_made) : firstDoubt(merges, merges.size());
  for (std::size_t i = 0; i < doubt; ++i) regions.merge(merges[i].into, merges[i].from);
  const std::map<int, int> number = numbersOf(regions.ofPatches());
  MergedDivision division;
  for (const int patch : evidence.patches.of_element) division.cell.push_back(number.at(regions.ofPatches()[patch]));
  const auto size = static_cast<Eigen::Index>(number.size());
  division.probability = Eigen::MatrixXf::Identity(size, size);
  if (num_parts > 0) return division;
  std::map<int, std::vector<int>> cells_of;
  for (const auto& [region, cell] : number) cells_of[region] = {cell};
  float least = 1.0f;
  for (std::size_t i = doubt; i < merges.size(); ++i) {
    least = std::min(least, static_cast<float>(1.0 / (1.0 + std::exp(-merges[i].log_odds))));
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
