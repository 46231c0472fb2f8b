#include "evaluate/shared/class_file.h"

#include "common/command_line/tool_errors.h"
#include "common/files/file_text.h"

namespace pcl_symmetry::apps {

namespace {

struct LeafClass {
  std::string full_name;  ///< behind its parents
  int number;             ///< among the classes that name models, from 0
};

std::map<std::string, LeafClass> classesOfModels(const std::string& path) {
  const std::string text = readWholeFile(path);
  TokenReader reader(text, path);
  if (reader.next() != "PSB") throw InputError(path + ": must begin with PSB");
  reader.count("version", 1, 1);
  // chosen: beyond any benchmark; keeps a damaged file from taking all memory
  constexpr std::uint64_t kMost = 1'000'000;
  // letters of a name behind its parents. chosen: the same; half would do too, without it each class can hold all
  // before
  constexpr std::size_t kLongestName = 10'000;
  const std::uint64_t num_classes = reader.count("number of classes", 1, kMost);
  const std::uint64_t num_models = reader.count("number of models", 1, kMost);
  std::map<std::string, LeafClass> class_of_models;
  std::map<std::string, std::string> full_names;
  int num_leaves = 0;
  for (std::uint64_t c = 1; c <= num_classes; ++c) {
    const std::string name(reader.next()), parent(reader.next());
    if (name.empty() || parent.empty())
      throw InputError(path + ": class " + std::to_string(c) + ", must have a name and a parent");
    const auto known = full_names.find(parent);
    const std::string full_name = known == full_names.end() ? name : known->second + "/" + name;
    if (full_name.size() > kLongestName)
      throw InputError(path + ": class " + std::to_string(c) +
                       ", its name and those of its parents must have <= " + std::to_string(kLongestName) + " letters");
    full_names[name] = full_name;
    const std::uint64_t size = reader.count("size of class", c, kMost);
    for (std::uint64_t i = 1; i <= size; ++i)
      class_of_models["m" + std::to_string(reader.count("model of class", c, kMost))] = {full_name, num_leaves};
    num_leaves += size > 0 ? 1 : 0;
  }
  if (class_of_models.size() != num_models)
    throw InputError(path + ": names " + std::to_string(class_of_models.size()) + " models, must be " +
                     std::to_string(num_models));
  return class_of_models;
}

}  // namespace

std::map<std::string, std::string> readClassFile(const std::string& path) {
  std::map<std::string, std::string> names;
  for (const auto& [model, leaf] : classesOfModels(path)) names[model] = leaf.full_name;
  return names;
}

std::map<std::string, int> leafClassNumbers(const std::string& path) {
  std::map<std::string, int> numbers;
  for (const auto& [model, leaf] : classesOfModels(path)) numbers[model] = leaf.number;
  return numbers;
}

std::set<std::string> modelsOfClassFile(const std::string& path) {
  std::set<std::string> names;
  for (const auto& [model, leaf] : classesOfModels(path)) names.insert(model);
  return names;
}

}  // namespace pcl_symmetry::apps
