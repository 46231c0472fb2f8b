#include "evaluate/retrieval/retrieval_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/random.h"

namespace pcl_symmetry::apps {

namespace {

constexpr std::size_t kConsidered = 32;  // answers of the E-measure; derived: its definition in the Princeton benchmark

/// Ranks, from 1, of the models of the query's class among all others.
std::vector<std::size_t> relevantRanks(const Eigen::MatrixXf& distances, const std::vector<std::string>& classes,
                                       std::size_t query) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < classes.size(); ++i)
    if (i != query) order.push_back(i);
  const auto column = static_cast<Eigen::Index>(query);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distances(static_cast<Eigen::Index>(a), column) < distances(static_cast<Eigen::Index>(b), column);
  });
  std::vector<std::size_t> ranks;
  for (std::size_t rank = 1; rank <= order.size(); ++rank)
    if (classes[order[rank - 1]] == classes[query]) ranks.push_back(rank);
  return ranks;
}

double gain(std::size_t rank) {
  return rank == 1 ? 1.0 : 1.0 / std::log2(static_cast<double>(rank));
}

void add(const std::vector<std::size_t>& ranks, RetrievalStatistics& sum) {
  const std::size_t k = ranks.size();
  const auto found = [&](std::size_t considered) {
    return static_cast<double>(std::upper_bound(ranks.begin(), ranks.end(), considered) - ranks.begin());
  };
  const auto num_relevant = static_cast<double>(k);
  ++sum.num_queries;
  sum.nearest += ranks.front() == 1 ? 1.0 : 0.0;
  sum.first_tier += found(k) / num_relevant;
  sum.second_tier += found(2 * k) / num_relevant;
  sum.e_measure += 2.0 * found(kConsidered) / (static_cast<double>(kConsidered) + num_relevant);
  double reached = 0.0, best = 0.0;
  for (std::size_t i = 0; i < k; ++i) {
    reached += gain(ranks[i]);
    best += gain(i + 1);
  }
  sum.dcg += reached / best;
  for (std::size_t r = 0; r < kNumRecalls; ++r) {
    const std::size_t needed = std::max<std::size_t>(1, (k * (r + 1) + kNumRecalls - 1) / kNumRecalls);
    sum.precision[r] += static_cast<double>(needed) / static_cast<double>(ranks[needed - 1]);
  }
}

void divide(RetrievalStatistics& sum) {
  if (sum.num_queries == 0) return;
  const double count = sum.num_queries;
  for (double* value : {&sum.nearest, &sum.first_tier, &sum.second_tier, &sum.e_measure, &sum.dcg}) *value /= count;
  for (double& value : sum.precision) value /= count;
}

}  // namespace

RetrievalStatistics retrievalStatistics(const Eigen::MatrixXf& distances, const std::vector<std::string>& classes) {
  RetrievalStatistics result;
  for (std::size_t query = 0; query < classes.size(); ++query) {
    const auto ranks = relevantRanks(distances, classes, query);
    if (!ranks.empty()) add(ranks, result);
  }
  divide(result);
  return result;
}

std::map<std::string, RetrievalStatistics> statisticsByClass(const Eigen::MatrixXf& distances,
                                                             const std::vector<std::string>& classes) {
  std::map<std::string, RetrievalStatistics> result;
  for (std::size_t query = 0; query < classes.size(); ++query) {
    const auto ranks = relevantRanks(distances, classes, query);
    if (!ranks.empty()) add(ranks, result[classes[query]]);
  }
  for (auto& [name, statistics] : result) divide(statistics);
  return result;
}

QueryScores queryScores(const Eigen::MatrixXf& distances, const std::vector<std::string>& classes) {
  QueryScores scores;
  for (std::size_t query = 0; query < classes.size(); ++query) {
    const auto ranks = relevantRanks(distances, classes, query);
    if (ranks.empty()) continue;
    RetrievalStatistics one;
    add(ranks, one);
    scores.nearest.push_back(one.nearest);
    scores.dcg.push_back(one.dcg);
    for (std::size_t r = 0; r < kNumRecalls; ++r) scores.precision[r].push_back(one.precision[r]);
    scores.classes.push_back(classes[query]);
  }
  return scores;
}

Gain pairedGain(const std::vector<double>& with, const std::vector<double>& without,
                const std::vector<std::string>& classes) {
  // chosen: the ends of the interval are the 50th of 2000 from either side; half makes them vary by some hundredths of
  // its width from seed to seed, twice gains nothing that is printed.
  constexpr std::size_t kNumDrawn = 2000;
  std::map<std::string, std::pair<double, double>> sums;  // of a class: differences, and their number
  for (std::size_t i = 0; i < with.size(); ++i) {
    auto& [difference, count] = sums[classes[i]];
    difference += with[i] - without[i];
    count += 1.0;
  }
  if (sums.empty()) return {0.0, 0.0, 0.0};
  std::vector<std::pair<double, double>> groups;
  for (const auto& [name, sum] : sums) groups.push_back(sum);
  const auto mean = [](const std::pair<double, double>& sum) { return sum.first / sum.second; };
  RandomStream random(1);
  std::vector<double> means;
  std::pair<double, double> all{0.0, 0.0};
  for (const auto& [difference, count] : groups) all = {all.first + difference, all.second + count};
  for (std::size_t draw = 0; draw < kNumDrawn; ++draw) {
    std::pair<double, double> drawn{0.0, 0.0};
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const auto& [difference, count] = groups[random.below(groups.size())];
      drawn = {drawn.first + difference, drawn.second + count};
    }
    means.push_back(mean(drawn));
  }
  std::sort(means.begin(), means.end());
  constexpr std::size_t kTail = kNumDrawn / 40;  // derived: 2.5 % at either end
  return {mean(all), means[kTail], means[kNumDrawn - 1 - kTail]};
}

}  // namespace pcl_symmetry::apps
