/// Which files the arguments of a tool name.
#pragma once

#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// A file to read, and the folder argument in which it was found, empty if the file itself was given.
struct InputFile {
  std::string path;
  std::string folder;
};

/// \param arguments files; "-", standard input; folders, with the shape files in them and in their subfolders, sorted
/// by name; patterns with *, ? and []; and lists "@FILE" of any of these, one on each line, with # before comments
/// \return the files in the order of the arguments
/// \throws InputError if a list or folder cannot be read or a pattern has no file. A missing file is kept, to be
/// reported with those that cannot be used.
std::vector<InputFile> inputFiles(const std::vector<std::string>& arguments);

/// \return whether one argument may name several files: a folder, a pattern or a list
bool standsForSeveral(const std::string& argument);

}  // namespace pcl_symmetry::apps
