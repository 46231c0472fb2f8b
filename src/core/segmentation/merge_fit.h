// Written by test/benchmark/fit_segments.py --every 1; do not edit.
#pragma once

#include "core/segmentation/region_merging.h"

namespace pcl_symmetry {

// Log odds per unit of each cue, by MergingEvidence, fitted to 130 meshes that people cut into parts.
inline constexpr std::array<MergeWeights, 2> kMergeFit{
    {// concavity: Rand distance 0.153
     {0.72, 1.08, -0.161, -0.636, -6.43, 0.27, -2.99, -1.85, 3.03, 0, 0, 0, 0, 0},
     // all: Rand distance 0.129
     {-3.08, 1.60, -0.85, -0.332, -4.29, 1.03, -3.20, -1.60, 2.23, -0.75, 2.42, -5.15, 8.95, 0.59}}};

}  // namespace pcl_symmetry
