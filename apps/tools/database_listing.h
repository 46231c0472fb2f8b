/// What a database holds, as text, JSON and CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::apps {

std::vector<ModelInfo> infosOf(const SymmetryDatabase& database, const std::vector<std::string>& names);

/// Seconds since 1970 as "2025-01-31T12:00:00Z".
std::string timeText(std::int64_t time);

nlohmann::json modelsJson(const std::vector<ModelInfo>& models);
/// A row for each model; tags are separated by spaces.
std::string modelsCSV(const std::vector<ModelInfo>& models);
/// Several lines for one model.
std::string modelText(const ModelInfo& model);

}  // namespace pcl_symmetry::apps
