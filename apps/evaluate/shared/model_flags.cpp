#include "evaluate/shared/model_flags.h"

namespace pcl_symmetry::apps {

void addModelFlags(CommandLine& line, std::vector<std::string>& folders, ModelSelection& selection) {
  line.positionals("folder", folders, "folders of .off, .ply, .obj and .stl meshes, which are sorted by name");
  addSelectionFlags(line, selection);
}

void addSelectionFlags(CommandLine& line, ModelSelection& selection) {
  line.text("list", "FILE", selection.list, "take only these names, without extension, one a line, # comments")
      .number("every", selection.every, Range::closed(1, 1'000'000), "take every N-th mesh of each folder")
      .number("first", selection.first, Range::closed(0, 1'000'000), "index of the first mesh taken of each folder")
      .number("max", selection.max, Range::closed(1, 1'000'000), "largest number of meshes taken of each folder");
}

}  // namespace pcl_symmetry::apps
