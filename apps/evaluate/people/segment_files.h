/// What people made of the meshes of the Princeton Segmentation Benchmark.
#pragma once

#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// The .seg files of a model: those in the folder of its name, or those beside the others that begin with its name and
/// "_"; sorted.
std::vector<std::string> segmentFilesOf(const std::string& folder, const std::string& model);

}  // namespace pcl_symmetry::apps
