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
inline const ConfidenceFit kConfidenceFit{{{{2.508, -1.439, -0.4066, -2.642, -0.268, -6.166, -3.523},
                                            {0.2623, -0.9371, -0.8362, -10.52, -3.209, -1.116},
                                            {4.957, -0.7157, -1.609, -0.6965, -2.396}}},
                                          {{{-6.98, 1.43}, {-18.4, 0.342}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
