#include "evaluate/shared/model_list.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <map>
#include <set>
#include <sstream>

#include "common/files/file_text.h"
#include "evaluate/shared/class_file.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

bool isMesh(const fs::path& path) {
  const std::string extension = boost::algorithm::to_lower_copy(path.extension().string());
  return extension == ".off" || extension == ".ply" || extension == ".obj" || extension == ".stl";
}

std::vector<fs::path> meshesOf(const std::string& folder) {
  boost::system::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder + ": must be a folder");
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (isMesh(entry->path()) && fs::is_regular_file(entry->path())) paths.push_back(entry->path());
  if (error) throw InputError(folder + ": " + error.message());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::set<std::string> namesIn(const std::string& path) {
  std::istringstream text(readWholeFile(path));
  std::set<std::string> names;
  for (std::string line; std::getline(text, line);) {
    line = line.substr(0, line.find('#'));
    boost::algorithm::trim(line);
    if (!line.empty()) names.insert(line);
  }
  return names;
}

/// Splits by class, so that near-duplicates of a model, which share its class, stay on its side of the split.
std::set<std::string> namesInFold(const ModelSelection& selection) {
  std::set<std::string> names;
  for (const auto& [name, number] : leafClassNumbers(*selection.classes))
    if (!selection.fold || number % selection.num_folds == *selection.fold) names.insert(name);
  return names;
}

/// Takes away the paths whose names are not wanted.
void keep(std::vector<fs::path>& paths, const std::set<std::string>& wanted) {
  paths.erase(std::remove_if(paths.begin(), paths.end(),
                             [&](const fs::path& path) { return !wanted.count(path.stem().string()); }),
              paths.end());
}

std::string folderName(const fs::path& path) {
  return fs::canonical(path).parent_path().filename().string();
}

std::string withExtension(const fs::path& path) {
  return path.stem().string() + "_" + path.extension().string().substr(1);
}

}  // namespace

std::vector<Model> listModels(const std::vector<std::string>& folders, const ModelSelection& selection) {
  if (selection.fold && !selection.classes) throw UsageError("-fold needs -classes");
  if (selection.fold && *selection.fold >= selection.num_folds) throw UsageError("-fold must be < -folds");
  std::vector<std::vector<fs::path>> found;
  std::map<std::string, int> num_stems, num_names;
  for (const std::string& folder : folders) {
    found.push_back(meshesOf(folder));
    for (const fs::path& path : found.back()) {
      ++num_stems[path.stem().string()];
      ++num_names[withExtension(path)];
    }
  }
  std::set<std::string> wanted;
  if (selection.list) wanted = namesIn(*selection.list);
  for (const std::string& name : wanted)
    if (!num_stems.count(name)) throw InputError(*selection.list + ": no folder holds a mesh named '" + name + "'");

  std::set<std::string> in_fold;
  if (selection.classes) in_fold = namesInFold(selection);

  std::vector<Model> models;
  for (std::vector<fs::path>& paths : found) {
    if (selection.list) keep(paths, wanted);
    if (selection.classes) keep(paths, in_fold);
    int taken = 0;
    for (std::size_t i = selection.first; i < paths.size(); i += selection.every) {
      if (selection.max && taken++ == *selection.max) break;
      const fs::path& path = paths[i];
      std::string name = path.stem().string();
      if (num_stems[name] > 1) name = withExtension(path);
      if (num_names[withExtension(path)] > 1) name = folderName(path) + "_" + name;
      models.push_back({name, path.string(), folderName(path) + "/" + path.filename().string()});
    }
  }
  if (models.empty()) throw InputError(folders.front() + ": no mesh (.off, .ply, .obj or .stl) is selected");
  return models;
}

}  // namespace pcl_symmetry::apps
