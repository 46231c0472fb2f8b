// Written by calibrate_planes; see README.md beside this file. Do not edit.
#pragma once

#include <array>
#include <vector>

#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

/// The fitted numbers of the decision, by EvidenceKind.
struct ConfidenceFit {
  std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms()
  std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()
};

// fitted: 178 models, tolerance 0.01 of the diameter.
inline const ConfidenceFit kConfidenceFit{{{{4.004, -0.5659, -0.6804, -8.096, -0.8323, -1.327},
                                            {-0.2893, -2.111, -2.892},
                                            {5.478, -0.7427, -1.632, -0.8914, -11.62}}},
                                          {{{-3.94, 1.06}, {-45.9, 0.991}, {-20.3, 0.8}}}};

}  // namespace pcl_symmetry
