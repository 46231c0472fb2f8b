#include "bop/model_files.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cctype>
#include <map>

#include "command_line/input_files.h"
#include "io/shape_file_kinds.h"

namespace pcl_symmetry::apps {

namespace {

std::vector<std::string> shapesIn(const std::string& folder) {
  std::vector<std::string> all, numbered;
  for (const auto& entry : boost::filesystem::directory_iterator(folder)) {
    if (!hasShapeExtension(entry.path().string())) continue;
    all.push_back(entry.path().string());
    if (boost::algorithm::starts_with(entry.path().filename().string(), "obj_")) numbered.push_back(all.back());
  }
  if (all.empty()) throw InputError(folder + ": holds no " + kShapeFilesOfFolders + " file");
  std::vector<std::string>& chosen = numbered.empty() ? all : numbered;
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// The number that the name of a file ends in; empty where it ends in none.
std::string numberOf(const std::string& path) {
  const std::string stem = boost::filesystem::path(path).stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto digits = std::find_if_not(stem.rbegin(), stem.rend(), is_digit).base();
  const auto number = std::find_if(digits, stem.end(), [](char c) { return c != '0'; });
  return digits != stem.end() && number == stem.end() ? "0" : std::string(number, stem.end());
}

}  // namespace

std::vector<ModelFile> modelFiles(const std::vector<std::string>& inputs) {
  std::vector<ModelFile> models;
  for (const std::string& input : inputs) {
    if (!boost::filesystem::is_directory(input)) {
      models.push_back({input, numberOf(input)});
      continue;
    }
    for (const std::string& path : shapesIn(input)) models.push_back({path, numberOf(path)});
  }
  std::map<std::string, std::string> path_of;
  for (const ModelFile& model : models) {
    if (model.key.empty()) continue;
    const auto [entry, is_new] = path_of.insert({model.key, model.path});
    if (!is_new) throw UsageError(model.path + " and " + entry->second + " are both model " + model.key);
  }
  int free = 1;
  for (ModelFile& model : models) {
    if (!model.key.empty()) continue;
    while (path_of.count(std::to_string(free)) > 0) ++free;
    model.key = std::to_string(free++);
  }
  return models;
}

}  // namespace pcl_symmetry::apps
