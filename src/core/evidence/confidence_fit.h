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
inline const ConfidenceFit kConfidenceFit{{{{2.005, -1.569, -0.4655, -2.851, -0.02213, -9.081, -3.823},
                                            {0.6539, -1.085, -0.6108, -11.45, -2.49, -0.9441},
                                            {4.957, -0.7157, -1.61, -0.6965, -2.396}}},
                                          {{{-6.72, 0.621}, {-11.8, 0.401}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
