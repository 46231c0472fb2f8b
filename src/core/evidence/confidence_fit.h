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

// clang-format off
// fitted: 500 models and shapes, tolerance 0.01 of the diameter.
inline const ConfidenceFit kConfidenceFit{{{{2.508, -1.442, -0.4107, -2.579, -0.2996, -5.813, -3.694},
                                            {0.3791, -0.9132, -0.7752, -10.85, -3.281, -0.9873},
                                            {4.957, -0.7157, -1.61, -0.6965, -2.396}}},
                                          {{{-6.98, 1.43}, {-16.1, 0.358}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
