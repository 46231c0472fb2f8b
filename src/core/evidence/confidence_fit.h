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
    {{{3.966, -0.4897, -0.6866, -7.246, -0.758, -1.365},
      {-0.7243, -2.254, -2.669},
      {4.581, -21.27, -10.1, -26.58, -0.5119}}},
    {{{-4.44, 1.14}, {-49.5, 1}, {-22.5, 0.795}}}};

}  // namespace pcl_symmetry
