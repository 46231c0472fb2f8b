#include "core/segmentation/merging/merge_cues.h"

namespace pcl_symmetry {

namespace {

/// Weights of a cue, log odds per unit of the cue, with each kind of evidence: 6, 9 and 14 weights that are not 0.
///
/// fitted: for each kind of evidence one logistic regression, on merges of regions of the models of the Princeton
/// Segmentation Benchmark with ids 1 modulo 4, each merge weighted by the product of the two areas to the power 0.65 to
/// 0.75. The target is the share of the pairs of faces, one in each region, that people put into one segment, so that
/// merging up to even odds follows the Rand index. Models with ids 3 modulo 4 were looked at with frozen weights only,
/// models with even ids never. The program of the fit is not in this repository: the weights cannot be made anew from
/// it. `pcl_symmetry_evaluate segmentation` measures what they give.
struct MergeWeight {
  Cue cue;
  double symmetry;   ///< MergingEvidence::Symmetry
  double concavity;  ///< MergingEvidence::SymmetryAndConcavity
  double all;        ///< MergingEvidence::All

  double of(MergingEvidence evidence) const {
    switch (evidence) {
      case MergingEvidence::Symmetry:
        return symmetry;
      case MergingEvidence::SymmetryAndConcavity:
        return concavity;
      case MergingEvidence::All:
        break;
    }
    return all;
  }
};

/// In the order of Cue. fitted: see MergeWeight.
constexpr MergeWeight kMergeWeights[kNumCues] = {
    {kAlways, -0.051, 1.14, -2.185},
    {kContact, 0.666, 0.8, 1.153},
    {kSmallArea, -0.193, 0.012, -0.847},
    {kLargeArea, -0.51, -0.729, -0.257},
    {kSupportDifference, -7.032, -5.918, -3.755},
    {kImages, 0.944, 0.327, 0.662},
    {kEdgeConcavity, 0.0, -5.539, -6.209},
    {kPatchConcavity, 0.0, -1.192, -1.25},
    {kInnerConcavity, 0.0, 2.73, 1.599},
    {kThicknessRatio, 0.0, 0.0, -1.045},
    {kConstriction, 0.0, 0.0, 1.553},
    {kSight, 0.0, 0.0, 0.148},
    {kRelativeSight, 0.0, 0.0, 3.469},
    {kSightOfSmall, 0.0, 0.0, 0.744},
};

}  // namespace

double logOddsOfOnePart(const Cues& cues, MergingEvidence evidence) {
  double log_odds = 0.0;
  for (const MergeWeight& weight : kMergeWeights) log_odds += weight.of(evidence) * cues[weight.cue];
  return log_odds;
}

}  // namespace pcl_symmetry
