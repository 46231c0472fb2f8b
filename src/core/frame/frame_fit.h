// Written by test/benchmark/fit_frames.py --fold 0 --every 1; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of frameProbabilities(): of whole clouds and of scans.
struct FrameFit {
  std::array<double, 8> whole, scan;
};

// Fitted to 1068 clouds of 356 models.
constexpr FrameFit kFrameFit{{-4.35, 4.23, 2.62, 1.799, -0.740, -1.17, 1.02, 3.11},
                             {-3.55, 6.53, 0.86, 1.207, -0.416, 0.43, 1.373, 2.23}};

}  // namespace pcl_symmetry
