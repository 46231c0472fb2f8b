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
inline const ConfidenceFit kConfidenceFit{{{{2.318, -1.575, -0.5353, -3.24, -0.09108, -9.206, -4.142},
                                            {0.6356, -1.081, -0.6048, -11.16, -2.523, -0.9471},
                                            {4.957, -0.7157, -1.61, -0.6965, -2.396}}},
                                          {{{-5.12, 0.574}, {-12.3, 0.4}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
