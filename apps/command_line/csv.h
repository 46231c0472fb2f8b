/// Tables of comma-separated values (RFC 4180, lines end with a line feed).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// \param cells strings and numbers; null is an empty cell.
/// \return a line with its end
std::string csvLine(const std::vector<nlohmann::json>& cells);

/// \return the first cell of a line
std::string firstCell(const std::string& line);

}  // namespace pcl_symmetry::apps
