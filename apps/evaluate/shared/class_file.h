/// Classifications of the Princeton Shape Benchmark.
#pragma once

#include <map>
#include <set>
#include <string>

namespace pcl_symmetry::apps {

/// \param path a .cla file: "PSB 1", the number of classes and of models, then for each class its name, its parent, the
/// number of its models and their numbers.
/// \return the class of each model, behind its parents ("vehicle/car"); models are called as the benchmark's files are:
/// "m" and the number.
/// \throws InputError where the file does not keep to this.
std::map<std::string, std::string> readClassFile(const std::string& path);

/// \return for each model the number of its leaf class: classes that name models are counted from 0 in the order of the
/// file, others are not counted.
/// \throws InputError as readClassFile().
std::map<std::string, int> leafClassNumbers(const std::string& path);

/// \return the models that it names.
std::set<std::string> modelsOfClassFile(const std::string& path);

}  // namespace pcl_symmetry::apps
