#include "evaluate/retrieval/retrieval_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace pcl_symmetry::apps
