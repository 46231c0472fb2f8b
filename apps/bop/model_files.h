/// The models that a command line names, and their numbers.
#pragma once

#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

struct ModelFile {
  std::string path;
  std::string key;  ///< number of the model
};

/// Files as they are; of a folder the files obj_* that hold shapes, or all shapes where there is none of that name, by
/// name.
/// \return each with the number that its name ends in; where there is none the first from 1 on that is free.
/// \throws UsageError where two files have one number; InputError for a folder without a shape.
std::vector<ModelFile> modelFiles(const std::vector<std::string>& inputs);

}  // namespace pcl_symmetry::apps
