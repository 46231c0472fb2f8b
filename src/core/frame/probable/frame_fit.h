// Written by calibrate_frames. Do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of frameProbabilities(): of whole clouds and of scans.
struct FrameFit {
  std::array<double, 6> whole, scan;
};

// fitted: 238 clouds of 119 models.
constexpr FrameFit kFrameFit{{-1.615, 3.703, 1.411, 1.535, -0.8428, 1.604},
                             {-1.506, 3.541, -0.1721, 1.824, -0.7254, 2.493}};

}  // namespace pcl_symmetry
