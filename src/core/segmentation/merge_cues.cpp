#include "core/segmentation/merge_cues.h"

#include "core/segmentation/merge_fit.h"

namespace pcl_symmetry {

std::vector<Cue> cuesOf(MergingEvidence evidence) {
  std::vector<Cue> cues{kAlways, kContact, kSmallArea, kLargeArea};
  if (usesSymmetry(evidence)) cues.insert(cues.end(), {kSupportDifference, kImages});
  if (usesConcavity(evidence)) cues.insert(cues.end(), {kEdgeConcavity, kPatchConcavity, kInnerConcavity});
  if (usesBody(evidence))
    cues.insert(cues.end(), {kThicknessRatio, kConstriction, kSight, kRelativeSight, kSightOfSmall});
  return cues;
}

const MergeWeights& fittedWeights(MergingEvidence evidence) {
  return kMergeFit[static_cast<std::size_t>(evidence)];
}

double logOddsOfOnePart(const Cues& cues, const MergeWeights& weights) {
  double log_odds = 0.0;
  for (std::size_t k = 0; k < cues.size(); ++k) log_odds += weights[k] * cues[k];
  return log_odds;
}

}  // namespace pcl_symmetry
