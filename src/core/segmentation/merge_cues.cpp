#include "core/segmentation/merge_cues.h"

#include "core/segmentation/merge_fit.h"

namespace pcl_symmetry {

const MergeWeights& fittedWeights(MergingEvidence evidence) {
  return kMergeFit[static_cast<std::size_t>(evidence)];
}

double logOddsOfOnePart(const Cues& cues, const MergeWeights& weights) {
  double log_odds = 0.0;
  for (std::size_t k = 0; k < cues.size(); ++k) log_odds += weights[k] * cues[k];
  return log_odds;
}

}  // namespace pcl_symmetry
