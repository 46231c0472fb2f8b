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
inline const ConfidenceFit kConfidenceFit{{{{2.427, -1.518, -0.3928, -2.671, -0.2825, -5.87, -3.779},
                                            {0.3545, -0.9549, -0.7495, -10.48, -3.267, -1.01},
                                            {4.957, -0.7157, -1.61, -0.6965, -2.396}}},
                                          {{{-6.9, 1.4}, {-15.9, 0.358}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
