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
inline const ConfidenceFit kConfidenceFit{{{{4.15, -0.514, -0.7198, -7.801, -0.7792, -1.348},
                                            {-0.2662, -2.484, -3.187},
                                            {5.478, -0.7427, -1.632, -0.8914, -11.62}}},
                                          {{{-3.94, 1.04}, {-49.5, 1}, {-20.3, 0.8}}}};

}  // namespace pcl_symmetry
