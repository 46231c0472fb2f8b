// Written by test/benchmark/fit_recognition.py --fold 0 --every 2; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Log odds that a scan shows a model: a constant, and the weights of what ModelEvidence says and of its lead.
inline constexpr std::array<double, 4> kRecognitionFit{-6.36, 2.388, 6.29, 4.48};

}  // namespace pcl_symmetry
