/// How well distances find shapes of the same class, as the Princeton Shape Benchmark measures it (Shilane et al.
/// 2004).
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

constexpr int kNumRecalls = 20;  ///< 0.05, 0.1 ... 1; derived: those of the Princeton benchmark

/// Means over queries, in [0, 1]. A query is one model, answered by all others in the order of their distances; models
/// that are alone in their class are none.
struct RetrievalStatistics {
  int num_queries = 0;
  double nearest = 0.0;      ///< share of queries whose nearest model is of their class
  double first_tier = 0.0;   ///< of the class, share among the first k, where the class has k others
  double second_tier = 0.0;  ///< and among the first 2 k
  double e_measure = 0.0;    ///< harmonic mean of precision and recall among the first 32
  /// Discounted cumulative gain, 1 + sum over the further answers of the class of 1 / log2(rank), by that of the best
  /// order.
  double dcg = 0.0;
  /// Precision at the first answer where the recall is reached.
  std::vector<double> precision = std::vector<double>(kNumRecalls, 0.0);
};

/// \param distances N x N, symmetric; ties go by index.
/// \param classes of the N models.
RetrievalStatistics retrievalStatistics(const Eigen::MatrixXf& distances, const std::vector<std::string>& classes);

/// The same of the queries of each class alone.
std::map<std::string, RetrievalStatistics> statisticsByClass(const Eigen::MatrixXf& distances,
                                                             const std::vector<std::string>& classes);

/// What each query alone reached.
struct QueryScores {
  std::vector<double> nearest;  ///< 1 where the nearest model is of the query's class, else 0
  std::vector<double> dcg;
  /// Of each recall, as RetrievalStatistics::precision, a value for each query.
  std::vector<std::vector<double>> precision = std::vector<std::vector<double>>(kNumRecalls);
  std::vector<std::string> classes;
};

QueryScores queryScores(const Eigen::MatrixXf& distances, const std::vector<std::string>& classes);

/// What one method is ahead of another by on the same queries.
struct Gain {
  double mean, low, high;  ///< mean difference and its 95 % interval
};

/// The interval by the bootstrap over classes (Efron 1979): queries of a class are alike and are drawn together.
/// \param with values of the queries, by one method.
/// \param without the same queries, by another.
/// \param classes of the queries.
Gain pairedGain(const std::vector<double>& with, const std::vector<double>& without,
                const std::vector<std::string>& classes);

}  // namespace pcl_symmetry::apps
