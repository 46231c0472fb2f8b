// Written by calibrate_planes (apps/calibrate); see README.md beside this file. Do not edit.
#pragma once

namespace pcl_symmetry {

/// Coefficients of the log odds that a plane is a symmetry; each summand has unit 1.
struct ConfidenceFit {
  struct Surface {
    double intercept = -1.0, per_off = -2.5, per_unknown = -20.0;
  } surface;
  struct Scan {
    double intercept = -2.4, per_off = -3.1, per_lost_score = -2.6;
  } scan;
  struct Volume {
    double intercept = 8.76, per_root_off = -23.0, per_lost_score = -1.06, per_missing_overlap = -26.9;
  } volume;
};
constexpr ConfidenceFit kConfidenceFit{};

}  // namespace pcl_symmetry
