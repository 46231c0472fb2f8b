// Written by test/benchmark/fit_recognition.py --fold 0 --every 3; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Log odds that a scan shows a model: a constant, and the weights of PoseEvidence::on_surface, merit and lead.
inline constexpr std::array<double, 4> kRecognitionFit{-11.52, 9.87, 5.09, 4.09};

}  // namespace pcl_symmetry
