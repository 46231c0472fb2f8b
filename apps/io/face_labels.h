/// Files of the Princeton Segmentation Benchmark: the segment of each face of a mesh, one whole number a line.
#pragma once

#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// \return one label >= 0 per face.
/// \throws InputError naming the first line that is wrong.
std::vector<int> readFaceLabels(const std::string& path);

/// Writes a .seg file whole.
void writeFaceLabels(const std::string& path, const std::vector<int>& labels);

}  // namespace pcl_symmetry::apps
