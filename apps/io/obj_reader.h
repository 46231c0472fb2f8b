/// Reads Wavefront .obj files.
#pragma once

#include <string>
#include <string_view>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// Vertices and faces; normals and texture coordinates are read over, also where a face names some that are not there.
/// Vertices of a file without faces are points; in a mesh those of equal coordinates are one.
/// \param path in errors.
/// \param text the whole file.
/// \throws InputError naming the vertex or face that is wrong.
ExactShape readOBJ(const std::string& path, std::string_view text);

}  // namespace pcl_symmetry::apps
