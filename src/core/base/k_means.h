#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pcl_symmetry {

struct KMeansOptions {
  int num_clusters = 2;      ///< >= 1
  int max_iterations = 100;  ///< >= 1, of each try
  int num_tries = 4;         ///< >= 1; the tightest clusters of several starts are taken
  std::uint64_t seed = 1;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct Clusters {
  std::vector<int> labels;  ///< N, in [0, centers.cols())
  Eigen::MatrixXf centers;  ///< D x K; K is less than num_clusters where there are not so many different features
  double sq_error = 0.0;    ///< weighted sum of the squared distances from the centers
};

/// Lloyd's k-means on weighted features, from starts that lie far apart (Arthur and Vassilvitskii 2007).
/// \param features D x N, finite, N >= 1. \param weights N values >= 0, not all 0.
Clusters kMeans(const Eigen::MatrixXf& features, const std::vector<float>& weights, const KMeansOptions& options = {});

}  // namespace pcl_symmetry
