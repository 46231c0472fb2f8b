// Written by calibrate_frames. Do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of frameProbabilities(): of whole clouds and of scans.
struct FrameFit {
  std::array<double, 8> whole, scan;
};

// fitted: 1068 clouds of 356 models.
constexpr FrameFit kFrameFit{{-5.1, 4.392, 2.628, 1.604, -0.4591, -0.8616, 1.602, 2.435},
                             {-3.827, 6.944, 0.9305, 1.478, -0.5368, 0.3106, 1.422, 2.679}};

}  // namespace pcl_symmetry
