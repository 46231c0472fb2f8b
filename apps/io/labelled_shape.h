/// Writes the segments of a shape: of points as a field, of faces as colours or as a .seg file.
#pragma once

#include <string>
#include <vector>

#include "io/shape_input.h"

namespace pcl_symmetry::apps {

/// \param path .seg: the labels of a mesh, one a line. .pcd or .ply of a cloud: with all its fields, and `label`
/// (unsigned; 4294967295 where there is none). .pcd of a mesh: the middles of its faces with `label`. .ply of a mesh:
/// its faces with `label` and a colour each.
/// \param labels one per face of a mesh or point of a cloud; below 0: none.
void saveLabelled(const std::string& path, const Shape& shape, const std::vector<int>& labels);

}  // namespace pcl_symmetry::apps
