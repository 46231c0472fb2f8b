#include "command_line/input_files.h"

#include <glob.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <sstream>

#include "io/file_text.h"
#include "io/shape_input.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

bool isList(const std::string& argument) {
  return argument.size() > 1 && argument.front() == '@';
}

bool isPattern(const std::string& argument) {
  boost::system::error_code error;
  return !fs::exists(argument, error) && argument.find_first_of("*?[") != std::string::npos;
}

bool isFolder(const std::string& argument) {
  boost::system::error_code error;
  return fs::is_directory(argument, error);
}

void addFolder(const std::string& folder, std::vector<InputFile>& files) {
  std::vector<std::string> found;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (fs::is_regular_file(entry.path()) && hasShapeExtension(entry.path().string()))
        found.push_back(entry.path().string());
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": " + error.code().message());
  }
  if (found.empty()) throw InputError(folder + ": holds no file of type " + kShapeFilesOfFolders);
  std::sort(found.begin(), found.end());
  for (const std::string& path : found) files.push_back({path, folder});
}

void addPattern(const std::string& pattern, std::vector<InputFile>& files) {
  glob_t found{};
  const int code = ::glob(pattern.c_str(), 0, nullptr, &found);
  const std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + (code == 0 ? found.gl_pathc : 0));
  ::globfree(&found);
  if (code != 0) throw InputError(pattern + ": no file has such a name");
  for (const std::string& path : paths)
    if (isFolder(path))
      addFolder(path, files);
    else
      files.push_back({path, ""});
}

void addArgument(const std::string& argument, std::vector<InputFile>& files);

void addList(const std::string& path, std::vector<InputFile>& files) {
  std::istringstream text(readTextFile(path));
  for (std::string line; std::getline(text, line);) {
    boost::algorithm::trim(line);
    if (!line.empty() && line.front() != '#') addArgument(line, files);
  }
}

void addArgument(const std::string& argument, std::vector<InputFile>& files) {
  if (isList(argument))
    addList(argument.substr(1), files);
  else if (isFolder(argument))
    addFolder(argument, files);
  else if (isPattern(argument))
    addPattern(argument, files);
  else
    files.push_back({argument, ""});
}

}  // namespace

bool standsForSeveral(const std::string& argument) {
  return isList(argument) || isFolder(argument) || isPattern(argument);
}

std::vector<InputFile> inputFiles(const std::vector<std::string>& arguments) {
  std::vector<InputFile> files;
  for (const std::string& argument : arguments) addArgument(argument, files);
  return files;
}

}  // namespace pcl_symmetry::apps
