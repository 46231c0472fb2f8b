// Written by calibrate_frames. Do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of frameProbabilities(): of whole clouds and of scans.
struct FrameFit {
  std::array<double, 6> whole, scan;
};

// fitted: by hand, to be replaced.
constexpr FrameFit kFrameFit{{-3.61, 3.68, 3.9, 1.69, -1.82, 1.69}, {-3.44, 4.92, 2.69, 1.53, -1.29, 2.98}};

}  // namespace pcl_symmetry
