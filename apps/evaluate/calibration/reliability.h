/// Do stated probabilities come true, and at which true share does a detector begin to say "symmetric"?
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/shared/proportion.h"

namespace pcl_symmetry::apps {

/// One answer with a stated probability.
struct Forecast {
  double confidence;  ///< in [0, 1]; what lies outside is moved to the end
  bool right;
};

/// One cloud: what its model is, and what was said of it.
struct ShareCase {
  double best_share;  ///< the greatest share of the surface that a plane maps to within the tolerance
  bool called;        ///< symmetric
};

struct ReliabilityBin {
  double low, high;  ///< of the confidence
  double sum_confidence = 0.0;
  Proportion right;

  double meanConfidence() const { return sum_confidence / right.total; }
};

struct ShareBin {
  double low, high;  ///< of the best share
  Proportion called;
};

/// Of one kind of clouds.
struct Reliability {
  std::string label;
  std::vector<ReliabilityBin> bins;  ///< ten of equal width
  int num_forecasts = 0;
  /// Mean over the answers of the difference between the mean confidence and the rate of right answers of their bin;
  /// NaN without answers.
  double calibration_error = 0.0;
  /// What chance alone leaves of it: its mean where each answer is right with the probability that was stated. NaN
  /// without answers.
  double chance_error = 0.0;
  double brier = 0.0;  ///< mean square of confidence less 1 for right and 0 for wrong answers; NaN without answers
  std::vector<ShareBin> shares;
};

Reliability reliabilityOf(const std::string& label, const std::vector<Forecast>& forecasts,
                          const std::vector<ShareCase>& cases);

/// Two tables: right answers by confidence, and, where there are cases, clouds called symmetric by the true share of
/// their best plane.
void printReliability(const std::vector<Reliability>& groups);

nlohmann::json toJson(const Reliability& reliability);

/// One row for each bin of each group.
std::string reliabilityCSV(const std::vector<Reliability>& groups);
std::string shareCSV(const std::vector<Reliability>& groups);

}  // namespace pcl_symmetry::apps
