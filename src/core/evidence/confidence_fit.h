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
// fitted: 322 models and shapes, tolerance 0.01 of the diameter.
inline const ConfidenceFit kConfidenceFit{{{{2.507, -0.7481, -0.4761, -3.597, -0.6053, -0.5547, -0.9002, -1.968, -3.915},
                                            {0.5174, -1.285, -0.5448, -10.07, -0.2585, -1.017},
                                            {5.259, -0.8867, -1.5, -1.086, -14.49}}},
                                          {{{-5.01, 0.796}, {-18.2, 0.228}, {-20.3, 0.8}}}};
// clang-format on

}  // namespace pcl_symmetry
