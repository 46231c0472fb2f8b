// Written by test/benchmark/fit_planes.py --fold 0 --every 2 --shapes 72; do not edit.
#pragma once

#include <array>
#include <vector>

#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

/// The fitted numbers of the decision, by CloudKind.
struct ConfidenceFit {
  std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms()
  std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()
};

// clang-format off
// Fitted to candidates of 250 models and shapes; symmetries among them: 1611 of 3949, 1577 of 7230, 995 of 2031.
inline const ConfidenceFit kConfidenceFit{
    {{{4.24, -1.331, -0.850, -4.91, -0.717, -3.55, -5.53},
      {0.535, -0.876, -0.954, -12.44, -4.207, -1.150},
      {5.780, -0.288, -1.440, -1.984, -2.429}}},
    {{{-5.78, 0.551}, {-9.79, 0.366}, {-20, 0.817}}}};
// clang-format on

}  // namespace pcl_symmetry
