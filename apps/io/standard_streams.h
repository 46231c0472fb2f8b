/// The name "-": standard input as a shape file, standard output as any file.
#pragma once

#include <memory>
#include <string>

#include "io/temporary_file.h"

namespace pcl_symmetry::apps {

inline bool isStandardStream(const std::string& path) {
  return path == "-";
}

/// All of standard input, put into a temporary file, because readers of meshes open files by name.
class StandardInput {
public:
  /// \throws InputError where it is empty, cannot be read, was read before or is of no known kind
  StandardInput();

  const std::string& path() const { return file_->name(); }
  /// \return text with "standard input" in place of the name of the temporary file
  std::string named(const std::string& text) const;

private:
  std::unique_ptr<TemporaryFile> file_;
};

/// \return the extension that a shape file of this content has, such as ".pcd"; empty where it is of no known kind
std::string extensionOfContent(const std::string& content);

/// Writes the bytes of a file to standard output.
/// \throws InputError where they cannot be written
void copyToStandardOutput(const std::string& path);

/// \throws InputError where the text cannot be written
void writeStandardOutput(const std::string& text);

}  // namespace pcl_symmetry::apps
