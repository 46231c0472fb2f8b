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
  int every = 1;
  int first = 0;
  std::optional<int> max;
};

/// The .off, .ply, .obj and .stl files of the folders, not of folders in them.
/// \throws InputError where a folder cannot be read, the list holds a name that no folder has, or nothing is selected.
std::vector<Model> listModels(const std::vector<std::string>& folders, const ModelSelection& selection);

}  // namespace pcl_symmetry::apps
