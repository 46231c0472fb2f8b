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
inline const ConfidenceFit kConfidenceFit{{{{2.471, -1.499, -0.3866, -2.617, -0.2983, -5.798, -3.803},
                                            {0.2694, -0.9311, -0.8381, -10.54, -3.208, -1.119},
                                            {4.956, -0.7164, -1.609, -0.6962, -2.396}}},
                                          {{{-6.82, 1.43}, {-18.4, 0.342}, {-21.5, 0.766}}}};
// clang-format on

}  // namespace pcl_symmetry
