/// Reads .stl and .glb files with Assimp, in the module pcl_symmetry_mesh_files.
#pragma once

#include <string>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// The triangles of the scene in its frame, or the vertices of a scene without triangles; those of equal coordinates
/// are one.
/// \param path in errors.
/// \param text the whole file; changed.
/// \param kind "stl" or "glb".
/// \throws InputError where Assimp cannot read the file, or it has neither faces nor points.
extern "C" void readMesh(const std::string& path, std::string& text, const std::string& kind, ExactShape& shape);

}  // namespace pcl_symmetry::apps
