/// Sums up what a detector found: rates, errors, precision and recall.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluate/clouds/test_clouds.h"
#include "evaluate/planes/plane_answers.h"
#include "evaluate/planes/plane_matching.h"
#include "evaluate/planes/visible_surface.h"
#include "evaluate/shared/proportion.h"

namespace pcl_symmetry::apps {

/// One cloud, what is known of it and what was answered.
struct CloudResult {
  std::string model, cloud;  ///< names
  CloudRecipe recipe;
  std::size_t num_points = 0;
  std::optional<double> view_angle;  ///< degrees from the view direction to the normal of the best reference plane
  SymmetryKind kind = SymmetryKind::Asymmetric;
  double best_share = 0.0;
  int num_reference_axes = 0;
  PlaneAnswers answers;
  MatchResult match;
  OperatingPoint operating_point;
  std::vector<ViewVerdict> view_verdicts;  ///< of a scan: one per answer

  bool firstIsRight() const { return match.rank == 1; }
  /// Whether any answer is called a symmetry.
  bool called() const;
  /// Whether the first answer that is called a symmetry, neutral ones left out, is right.
  bool decidedRight() const;
  /// \return false answers that are called symmetries; with \p verdict only those.
  int numFalse(std::optional<ViewVerdict> verdict = std::nullopt) const;
};

/// Decisions at one operating point.
struct DecisionStatistics {
  Proportion decided_right;            ///< of symmetric clouds
  Proportion asymmetric_called;        ///< symmetric, of asymmetric clouds
  Proportion nearly_called;            ///< symmetric, of nearly symmetric clouds
  Proportion asymmetric_contradicted;  ///< of asymmetric scans: a visible point contradicts an answer that is called
  double false_per_cloud = 0.0;        ///< answers that are called, on symmetric clouds; NaN where there is none
  int num_contradicted = 0, num_undecidable = 0;  ///< false answers that are called, on all scans, by ViewVerdict
};

/// Rates in [0, 1], NaN where there is nothing to count. Nearly symmetric clouds count in none but their own.
struct PlaneStatistics {
  DecisionStatistics decisions;
  int num_symmetric = 0, num_asymmetric = 0, num_nearly = 0, num_failed = 0;
  double first_rate = 0.0;      ///< symmetric clouds whose first answer is right; neutral answers do not count
  double five_rate = 0.0;       ///< symmetric clouds with a right answer among the first five
  double no_answer_rate = 0.0;  ///< symmetric clouds without any
  double recall = 0.0;          ///< references found
  double median_angle = 0.0, p90_angle = 0.0;                ///< degrees, of the best-ranked right answers
  double median_offset = 0.0, p90_offset = 0.0;              ///< diagonals
  int num_axes = 0;                                          ///< axes among the references
  double axis_rate = 0.0;                                    ///< of them found as axes
  double median_axis_angle = 0.0, median_axis_offset = 0.0;  ///< degrees, diagonals
  double median_ms = 0.0, p95_ms = 0.0;
  double average_precision = 0.0;
};

using CloudResults = std::vector<const CloudResult*>;

PlaneStatistics summarize(const CloudResults& results);

/// All answers with a score of at least this one: how many are right, and how many of the references are found.
struct PrecisionRecall {
  double score, precision, recall;
};

/// By falling score, over symmetric and asymmetric clouds; neutral answers do not count.
std::vector<PrecisionRecall> precisionRecall(const CloudResults& results);

/// Area under the curve, where precision is the best at this recall or more.
double averagePrecision(const std::vector<PrecisionRecall>& curve);

/// \param share in [0, 1].
/// \return the value that this share of the values does not exceed, between two of them on a
/// straight line; NaN for none.
double quantile(std::vector<double> values, double share);

}  // namespace pcl_symmetry::apps
