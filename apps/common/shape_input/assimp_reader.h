/// Reads .obj and .stl files with Assimp.
#pragma once

#include <string>

#include "common/shape_input/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// A mesh whose vertices are minus the shift.
struct ShiftedMesh {
  pcl::PolygonMesh mesh;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Vertices of exactly equal coordinates are joined: STL repeats them for each face, OBJ for each group.
/// \throws InputError where Assimp cannot read the file, or it has no faces
pcl::PolygonMesh readSTL(const std::string& path);

/// The vertices of a .obj file without faces are points.
/// \throws InputError where Assimp cannot read the file, or it has neither faces nor points
ShiftedMesh readOBJ(const std::string& path);

}  // namespace pcl_symmetry::apps
