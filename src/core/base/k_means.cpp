#include "core/base/k_means.h"

#include <limits>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

/// Draws the first center with a probability proportional to weight, each following one proportional to weight times
/// squared distance from the closest center so far.
Eigen::MatrixXf spreadCenters(const Eigen::MatrixXf& features, const std::vector<float>& weights, int num_clusters,
                              RandomStream& random) {
  const Eigen::Index size = features.cols();
  Eigen::MatrixXf centers(features.rows(), 0);
  Eigen::VectorXd chance = Eigen::Map<const Eigen::VectorXf>(weights.data(), size).cast<double>();
  Eigen::VectorXf sq_distance = Eigen::VectorXf::Constant(size, std::numeric_limits<float>::infinity());
  while (centers.cols() < num_clusters && chance.sum() > 0.0) {
    double rest = random.uniform() * chance.sum();
    Eigen::Index chosen = 0;
    while (chosen + 1 < size && (rest -= chance[chosen]) >= 0.0) ++chosen;
    while (chance[chosen] <= 0.0) --chosen;  // rounding can end the walk at a feature of probability 0
    centers.conservativeResize(Eigen::NoChange, centers.cols() + 1);
    centers.rightCols(1) = features.col(chosen);
    sq_distance = sq_distance.cwiseMin((features.colwise() - features.col(chosen)).colwise().squaredNorm().transpose());
    for (Eigen::Index i = 0; i < size; ++i) chance[i] = static_cast<double>(weights[i]) * sq_distance[i];
  }
  return centers;
}

/// Assigns every feature to its closest center.
/// \return whether a label changed.
bool assign(const Eigen::MatrixXf& features, const std::vector<float>& weights, Clusters& clusters) {
  checkCancelled();
  bool changed = false;
  clusters.sq_error = 0.0;
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    Eigen::Index closest = 0;
    const float sq_distance = (clusters.centers.colwise() - features.col(i)).colwise().squaredNorm().minCoeff(&closest);
    clusters.sq_error += static_cast<double>(weights[i]) * sq_distance;
    changed |= clusters.labels[i] != static_cast<int>(closest);
    clusters.labels[i] = static_cast<int>(closest);
  }
  return changed;
}

/// Moves each center to the weighted mean of its features; a center without features stays.
void moveCenters(const Eigen::MatrixXf& features, const std::vector<float>& weights, Clusters& clusters) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(features.rows(), clusters.centers.cols());
  Eigen::VectorXd totals = Eigen::VectorXd::Zero(clusters.centers.cols());
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    const double weight = weights[i];
    sums.col(clusters.labels[i]) += weight * features.col(i).cast<double>();
    totals[clusters.labels[i]] += weight;
  }
  for (Eigen::Index k = 0; k < totals.size(); ++k)
    if (totals[k] > 0.0) clusters.centers.col(k) = (sums.col(k) / totals[k]).cast<float>();
}

}  // namespace

Clusters kMeans(const Eigen::MatrixXf& features, const std::vector<float>& weights, int num_clusters,
                std::uint64_t seed) {
  constexpr int num_tries = 4, max_iterations = 100;
  Clusters best;
  for (int attempt = 0; attempt < num_tries; ++attempt) {
    RandomStream random(seed, attempt);
    Clusters clusters;
    clusters.labels.assign(features.cols(), -1);
    clusters.centers = spreadCenters(features, weights, num_clusters, random);
    for (int i = 0; i < max_iterations && assign(features, weights, clusters); ++i)
      moveCenters(features, weights, clusters);
    if (attempt == 0 || clusters.sq_error < best.sq_error) best = std::move(clusters);
  }
  return best;
}

}  // namespace pcl_symmetry
