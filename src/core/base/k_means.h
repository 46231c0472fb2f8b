#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pcl_symmetry {

struct KMeansOptions {
  int num_clusters = 2;      ///< k, >= 1
  int max_iterations = 100;  ///< of each try, >= 1
  int num_tries = 4;         ///< >= 1; the one with the least error counts
  std::uint64_t seed = 1;    ///< of the starts

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct Clusters {
  std::vector<int> labels;  ///< N, in [0, K)
  Eigen::MatrixXf centers;  ///< D x K; K < num_clusters if there are fewer distinct features of positive weight
  double sq_error = 0.0;    ///< weighted sum of the squared distances from the centers
};

/// Lloyd's k-means on weighted features, from starts that lie far apart (k-means++, Arthur and Vassilvitskii 2007).
/// \param features D x N, finite, N >= 1.
/// \param weights N values >= 0, not all 0.
/// \return the clusters of the best try; the same for the same seed.
/// \throws std::invalid_argument for bad options, no feature, or weights that do not fit.
Clusters kMeans(const Eigen::MatrixXf& features, const std::vector<float>& weights, const KMeansOptions& options = {});

}  // namespace pcl_symmetry
