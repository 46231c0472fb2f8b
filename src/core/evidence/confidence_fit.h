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

// fitted: 178 models, tolerance 0.01 of the diameter.
inline const ConfidenceFit kConfidenceFit{
    {{{2.109, -1.246, -9.495, -1.076, -59.7},
      {-0.7243, -2.254, -2.669},
      {4.544, -21.26, -10.5, -26.15, -24.78}}},
    {{{-3.82, 0.525}, {-49.5, 1.01}, {-22.6, 0.801}}}};

}  // namespace pcl_symmetry
