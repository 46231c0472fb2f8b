#include "class_file.h"

#include "file_text.h"
#include "tool_errors.h"

namespace pcl_symmetry::apps {

std::set<std::string> modelsOfClassFile(const std::string& path) {
  const std::string text = readWholeFile(path);
  TokenReader reader(text, path);
  if (reader.next() != "PSB") throw InputError(path + ": must begin with PSB");
  reader.count("version", 1, 1);
  constexpr std::uint64_t kMost = 1'000'000;
  const std::uint64_t num_classes = reader.count("number of classes", 1, kMost);
  const std::uint64_t num_models = reader.count("number of models", 1, kMost);
  std::set<std::string> names;
  for (std::uint64_t c = 1; c <= num_classes; ++c) {
    if (reader.next().empty() || reader.next().empty())
      throw InputError(path + ": class " + std::to_string(c) + ", must have a name and a parent");
    const std::uint64_t size = reader.count("size of class", c, kMost);
    for (std::uint64_t i = 1; i <= size; ++i)
      names.insert("m" + std::to_string(reader.count("model of class", c, kMost)));
  }
  if (names.size() != num_models)
    throw InputError(path + ": names " + std::to_string(names.size()) + " models, must be " +
                     std::to_string(num_models));
  return names;
}

}  // namespace pcl_symmetry::apps
