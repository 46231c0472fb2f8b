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

// fitted: 322 models and shapes, tolerance 0.01 of the diameter.
inline const ConfidenceFit kConfidenceFit{{{{3.373, -0.9631, -0.4842, -4.848, -0.851, -1.193, -5.123},
                                            {0.7305, -2.108, -11.61, -2.029},
                                            {5.467, -0.7502, -1.618, -0.8992, -11.6}}},
                                          {{{-5.01, 0.796}, {-18.2, 0.228}, {-20.3, 0.8}}}};

}  // namespace pcl_symmetry
