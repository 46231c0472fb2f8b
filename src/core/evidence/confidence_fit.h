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
inline const ConfidenceFit kConfidenceFit{{{{2.074, -0.2482, -0.4639, -5.121, -0.5734, -1.062, -1.148, -1.418, -3.216},
                                            {0.2074, -0.8723, -0.9159, -11.41, -0.6846, -1.03},
                                            {5.257, -0.8864, -1.497, -1.086, -14.5}}},
                                          {{{-5.95, 1.04}, {-18.4, 0.342}, {-21.5, 0.733}}}};
// clang-format on

}  // namespace pcl_symmetry
