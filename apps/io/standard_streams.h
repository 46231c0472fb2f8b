/// The name "-": standard input as a shape file, standard output as any file.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

inline bool isStandardStream(const std::string& path) {
  return path == "-";
}

/// \return all of standard input.
/// \throws InputError where it is empty, cannot be read or was read before
std::string readStandardInput();

/// \return the extension that a shape file of this content has, such as ".pcd"; empty where it is of no known kind
std::string extensionOfContent(const std::string& content);

/// \throws InputError where the text cannot be written
void writeStandardOutput(const std::string& text);

}  // namespace pcl_symmetry::apps
