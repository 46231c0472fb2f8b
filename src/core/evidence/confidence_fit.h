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
inline const ConfidenceFit kConfidenceFit{{{{1.895, -0.2631, -0.4674, -4.93, -0.535, -0.9974, -1.179, -3.181},
                                            {0.1733, -0.8384, -0.9274, -10.46, -3.156, -1.104},
                                            {5.404, -0.8448, -1.639, -0.9785, -12.68}}},
                                          {{{-5.95, 1.04}, {-18.4, 0.342}, {-21.5, 0.733}}}};
// clang-format on

}  // namespace pcl_symmetry
