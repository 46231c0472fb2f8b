#include "core/segmentation/region_merging.h"

#include <algorithm>
#include <map>
#include <set>

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
    const double log_odds = logOddsOfOnePart(regions.cues(a, b), weights_);
    log_odds_[std::minmax(a, b)] = log_odds;
    queue_.insert({log_odds, std::minmax(a, b)});
  }

private:
  const MergeWeights& weights_;
  std::set<std::pair<double, RegionPair>> queue_;
  std::map<RegionPair, double> log_odds_;
};

}  // namespace

MergeSequence mergeRegions(Regions regions, const MergeWeights& weights) {
  PairQueue queue(weights);
  for (int a = 0; a < regions.size(); ++a)
    for (const int b : regions.neighbors(a))
      if (a < b) queue.update(regions, a, b);

  MergeSequence sequence;
  bool likely = true;
  while (!queue.empty()) {
    const auto [log_odds, pair] = queue.likeliest();
    likely = likely && log_odds > 0.0;
    if (likely) ++sequence.num_likely;
    const auto [a, b] = pair;
    for (const int c : regions.neighbors(b)) queue.remove(b, c);
    regions.merge(a, b);
    sequence.merges.push_back({a, b, log_odds});
    for (const int c : regions.neighbors(a)) queue.update(regions, a, c);
  }
  return sequence;
}

Regions merged(Regions regions, const std::vector<Merge>& merges, std::size_t num_merges) {
  for (std::size_t i = 0; i < num_merges; ++i) regions.merge(merges[i].into, merges[i].from);
  return regions;
}

}  // namespace pcl_symmetry
