#pragma once

#include <string>
#include <vector>

#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::detail {

/// The models of a folder that version 0.1 of this library wrote: manifest.txt and a cloud for each model.
/// \throws pcl::IOException naming file and reason.
std::vector<ModelInput> modelsOfOldFolder(const std::string& folder);

}  // namespace pcl_symmetry::detail
