/// Which files the arguments of a tool stand for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// A file to read, and the folder among the arguments that it was found in, empty where the file itself was given.
struct InputFile {
  std::string path;
  std::string folder;
};

/// Files in the order of the arguments. A million names take the memory of their letters and 12 bytes each, so that
/// what a tool holds hardly depends on the number of its inputs.
class InputFiles {
public:
  /// \param folder the same as that of the file before, or another one.
  void add(const std::string& path, const std::string& folder = "");

  std::size_t size() const { return begins_.size(); }
  /// \param i below size().
  std::string path(std::size_t i) const;
  InputFile operator[](std::size_t i) const { return {path(i), folders_[folder_of_[i]]}; }

private:
  std::string letters_;              ///< of all paths, one after the other
  std::vector<std::size_t> begins_;  ///< of each path in letters_
  std::vector<std::uint32_t> folder_of_;
  std::vector<std::string> folders_;
};

/// \param arguments files; "-", standard input; folders, with the shape files in them and in folders of theirs, sorted
/// by name; patterns with *, ? and []; and lists "@FILE" of any of these, one on each line, # before comments
/// \throws InputError where a list or folder cannot be read or a pattern has no file. A file that is missing is kept,
/// to be reported with those that cannot be used.
InputFiles inputFiles(const std::vector<std::string>& arguments);

/// \return whether the name ends in one of kShapeFilesOfFolders, in capitals or not
bool hasShapeExtension(const std::string& path);

/// \return whether one argument may stand for several files: a folder, a pattern or a list
bool standsForSeveral(const std::string& argument);

}  // namespace pcl_symmetry::apps
