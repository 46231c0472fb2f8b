/// Fits the weights of merging to what people put together.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibrate/merge_samples.h"
#include "evaluate/calibration/logistic_regression.h"

namespace pcl_symmetry::apps {

/// One mesh.
struct PeopledModel {
  std::string category;
  const PeopledDivision* division;
};

struct MergeFit {
  MergeWeights weights{};
  double rand = 0.0;  ///< mean over models of the Rand distance of whole patches
};

/// The fit and what it was made from.
struct MergeFitting {
  MergeFit fit;
  std::size_t num_samples = 0;
  /// Of the 95 % intervals. Merges of one model belong together: the spread of the models' gradients counts (sandwich
  /// estimator with one group a model).
  MergeWeights half_width{};
};

/// A point of the regularisation path: models are measured with weights that were fitted to other categories.
struct PathPoint {
  double ridge;
  MergeWeights weights;  ///< from all models
  double rand;           ///< mean over models, the category of each left out of the fit
};

class MergeFitter {
public:
  /// \param models kept by reference.
  /// \param cues that may have a weight, the constant first.
  /// \param num_threads 0 = all.
  MergeFitter(const std::vector<PeopledModel>& models, std::vector<Cue> cues, int num_threads);

  /// Merges with weights, fits weights to these merges, and so on, from a rule that merges small regions first; then
  /// the constant is moved to the least mean Rand distance. The round with the least distance counts.
  MergeFitting fit();

  /// After fit(): the samples of its last rounds, with other strengths of the pull to 0.
  std::vector<PathPoint> path(const std::vector<double>& ridges) const;

private:
  using Round = std::vector<MergeRun>;  // by model

  Round run(const MergeWeights& weights) const;
  LogisticCases casesWithout(const std::string& category) const;
  MergeWeights fitted(const LogisticCases& cases, double ridge, const MergeWeights& start) const;

  const std::vector<PeopledModel>& models_;
  const std::vector<Cue> cues_;
  const int num_threads_;
  std::vector<Round> rounds_;
};

}  // namespace pcl_symmetry::apps
