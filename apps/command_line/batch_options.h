/// The flags of tools that take one shape or many.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line/command_line.h"

namespace pcl_symmetry::apps {

/// For the help of tools whose inputs are all their arguments without a flag.
inline const char* const kManyInputs =
    "files (.pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv), folders, patterns in quotes, lists "
    "@FILE, or - for standard "
    "input";
/// For the help of tools that take an output after their input.
inline const char* const kOneOrManyInputs =
    "file (.pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv), - for standard input, or many: a "
    "folder, a pattern in quotes, "
    "a "
    "list @FILE";

struct BatchOptions {
  std::vector<std::string> inputs;  ///< as inputFiles() takes them
  std::optional<std::string> csv_path;
  bool resume = false;
  /// What the tool writes of each input besides JSON and CSV: names in which {} stands for the name of the input.
  std::vector<const std::optional<std::string>*> outputs;

  /// Adds -csv and -resume.
  void addTo(CommandLine& line) {
    line.text("csv", "FILE", csv_path, "write the result as a table of comma-separated values")
        .flag("resume", resume,
              "with several inputs and -json FILE: keep what FILE holds, and go on with the inputs that it does not");
  }
};

}  // namespace pcl_symmetry::apps
