/// What a fit decides on clouds that may be others than those it was fitted to.
#pragma once

#include <string>
#include <vector>

#include "calibrate/planes/confidence_fitting.h"
#include "evaluate/calibration/reliability.h"
#include "evaluate/shared/proportion.h"

namespace pcl_symmetry::apps {

/// Decisions on one kind of clouds, counted as pcl_symmetry_evaluate does.
struct GroupDecisions {
  std::string group;      ///< whole, noise, cut off 0.2, scan, ...
  Proportion right;       ///< of symmetric models: the best plane that is called, nearly symmetric ones left out
  Proportion asymmetric;  ///< called symmetric
  int num_false = 0;      ///< asymmetric planes that are called, on symmetric models
  std::vector<Forecast> forecasts;  ///< of all planes that would be listed
};

/// \param samples those of one cloud side by side.
std::vector<GroupDecisions> decisionsOf(const std::vector<EvidenceSample>& samples, const DecisionFit& fit,
                                        const EvidenceUnits& units = {});

/// A row for each group, and whether the stated probabilities come true.
void printDecisions(const std::vector<GroupDecisions>& groups);

/// Each chosen unit at half and at twice its value: a fit to \p samples, and what it decides on \p others.
void printSensitivity(const std::vector<EvidenceSample>& samples, const std::vector<EvidenceSample>& others);

}  // namespace pcl_symmetry::apps
