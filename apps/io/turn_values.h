/// Axes of turns of scans as tools write them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry::apps {

/// One object for each axis, input frame.
/// \param shift that was subtracted from the input.
nlohmann::json turnsJson(const std::vector<SymmetryTurn>& turns, const Eigen::Vector3d& shift);

/// A line such as "axis of order 6: through 0 0 0 along 0.000000 0.000000 1.000000, confidence 0.973".
std::string lineOf(const SymmetryTurn& turn, const Eigen::Vector3d& shift);

}  // namespace pcl_symmetry::apps
