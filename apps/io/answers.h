/// Answers as tools write them: words, lines of tables, JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

const char* toString(PlaneKind kind);

/// Where the viewpoint of a scan is known from.
const char* toString(ViewpointSource source);

/// "1 plane", "2 planes".
/// \param many where it is not that with an s.
std::string counted(std::size_t number, const std::string& one, const std::string& many = "");

/// Axes of turns of scans, one object for each, input frame.
/// \param shift that was subtracted from the input.
nlohmann::json turnsJson(const std::vector<SymmetryTurn>& turns, const Eigen::Vector3d& shift);

/// A line such as "axis of order 6: through 0 0 0 along 0.000000 0.000000 1.000000, confidence 0.973".
std::string lineOf(const SymmetryTurn& turn, const Eigen::Vector3d& shift);

}  // namespace pcl_symmetry::apps
