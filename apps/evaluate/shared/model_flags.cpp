#include "evaluate/shared/model_flags.h"

namespace pcl_symmetry::apps {

void addModelFlags(CommandLine& line, std::vector<std::string>& folders, ModelSelection& selection) {
  line.positionals("folder", folders, "folders of .off, .ply, .obj and .stl meshes, which are sorted by name");
  addSelectionFlags(line, selection);
}

void addSelectionFlags(CommandLine& line, ModelSelection& selection) {
  line.text("list", "FILE", selection.list, "take only these names, without extension, one a line, # comments")
      .text("classes", "FILE", selection.classes,
            "take only the models of this classification of the Princeton Shape Benchmark (.cla)")
      .number(
          "fold", selection.fold, Range::closed(0, 999),
          "with -classes: take only models whose leaf class number (from 0, in the order of the file) modulo -folds "
          "is this one")
      .number("folds", selection.num_folds, Range::closed(1, 1000), "number of folds, see -fold")
      .number("every", selection.every, Range::closed(1, 1'000'000), "take every N-th mesh of each folder")
      .number("first", selection.first, Range::closed(0, 1'000'000), "index of the first mesh taken of each folder")
      .number("max", selection.max, Range::closed(1, 1'000'000), "largest number of meshes taken of each folder");
}

}  // namespace pcl_symmetry::apps
