/// The flags that choose the meshes of an evaluation.
#pragma once

#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

/// Folders of meshes, and the flags of addSelectionFlags().
void addModelFlags(CommandLine& line, std::vector<std::string>& folders, ModelSelection& selection);

/// -list, -classes, -fold, -folds, -every, -first and -max.
void addSelectionFlags(CommandLine& line, ModelSelection& selection);

}  // namespace pcl_symmetry::apps
