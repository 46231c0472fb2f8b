// Written by test/benchmark/fit_planes.py --fold 0 --every 2 --shapes 72; do not edit.
#pragma once

#include <array>
#include <vector>

#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

/// The fitted numbers of the decision, by CloudKind.
struct ConfidenceFit {
  std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms(), then that of furtherTerm()
  std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()
};

// clang-format off
// Fitted to candidates of 250 models and shapes; symmetries among them: 1610 of 3945, 1580 of 7193, 995 of 2031.
inline const ConfidenceFit kConfidenceFit{
    {{{4.78, -1.370, -0.857, -5.18, -1.083, -3.76, -5.57},
      {0.571, -0.886, -0.930, -12.24, -4.185, -1.194},
      {5.780, -0.288, -1.440, -1.984, -2.429}}},
    {{{-6.47, 0.539}, {-9.81, 0.367}, {-20, 0.817}}}};
// clang-format on

}  // namespace pcl_symmetry
