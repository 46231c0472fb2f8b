/// Which meshes of which folders an evaluation runs over, and what each is called.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line/tool_errors.h"

namespace pcl_symmetry::apps {

struct Model {
  /// Unique in an evaluation: the file's name without extension; where several files share it, with the extension
  /// ("pig_stl"), and where that is shared too, behind the folder's name.
  std::string name;
  std::string path;
  std::string key;  ///< "folder/file.off", the same wherever the folder lies
};

/// The meshes of each folder, sorted by name, with index first, first + every, first + 2 every ..., at most max.
struct ModelSelection {
  std::optional<std::string> list;  ///< a file of names without extension, one a line, # comments: others do not count
  std::optional<std::string> classes;  ///< a .cla file: models that it does not name do not count
  std::optional<int> fold;  ///< with classes: only models whose leaf class number, modulo num_folds, is this one
  int num_folds = 3;
  int every = 1;
  int first = 0;
  std::optional<int> max;
};

/// The .off, .ply, .obj and .stl files of the folders, not of folders in them.
/// \throws InputError where a folder cannot be read, the list holds a name that no folder has, or nothing is selected;
/// UsageError for a fold without classes, or one that is not below the number of folds.
std::vector<Model> listModels(const std::vector<std::string>& folders, const ModelSelection& selection);

}  // namespace pcl_symmetry::apps
