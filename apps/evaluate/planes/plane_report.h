/// What `pcl_symmetry_evaluate planes` prints and writes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/calibration/reliability.h"
#include "evaluate/planes/plane_statistics.h"

namespace pcl_symmetry::apps {

/// One line of the table: clouds that were made the same way.
struct CloudGroup {
  std::string label;
  double x = 0.0;  ///< the value that a sweep varies
  CloudResults results;
  PlaneStatistics statistics;
};

/// By recipe; with Sweep::Views by the angle between view direction and normal, ten degrees each.
std::vector<CloudGroup> groupResults(const std::vector<CloudResult>& results, Sweep sweep);

/// Decisions of each group with 95 % Wilson intervals.
void printDecisions(const std::vector<CloudGroup>& groups, const OperatingPoint& operating_point);

/// Rankings, accuracy and times: one line for each group, with a heading.
void printRankings(const std::vector<CloudGroup>& groups);

/// Stated probabilities of all answers against references, nearly symmetric clouds included.
std::vector<Reliability> reliabilities(const std::vector<CloudGroup>& groups);

nlohmann::json toJson(const std::vector<CloudGroup>& groups);

/// One row for each cloud, with all that is known of it. Angles in degrees, offsets in per cent of the diagonal.
std::string cloudCSV(const std::vector<CloudResult>& results);

/// One row for each model, with the rates over its clouds.
std::string modelCSV(const std::vector<CloudResult>& results);

/// One row for each distinct score of each group.
std::string precisionRecallCSV(const std::vector<CloudGroup>& groups);

/// Precision against recall of each group, or, for a sweep, the rates against what it varies.
void drawChart(const std::vector<CloudGroup>& groups, Sweep sweep, const std::string& path);

}  // namespace pcl_symmetry::apps
