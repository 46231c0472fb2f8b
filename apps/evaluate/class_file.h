/// Which models a classification of the Princeton Shape Benchmark names.
#pragma once

#include <set>
#include <string>

namespace pcl_symmetry::apps {

/// \param path a .cla file: "PSB 1", the number of classes and of models, then for each class its name, its parent, the
/// number of its models and their numbers. \return names of the models as the benchmark's files have them: "m" and the
/// number. \throws InputError where the file does not keep to this.
std::set<std::string> modelsOfClassFile(const std::string& path);

}  // namespace pcl_symmetry::apps
