/// Reads .obj and .stl files with Assimp.
#pragma once

#include "io/mesh_files.h"

namespace pcl_symmetry::apps {

class AssimpMeshFiles : public MeshFiles {
public:
  /// \throws InputError where Assimp cannot read the file, or it has no faces
  pcl::PolygonMesh readSTL(const std::string& path) const override;
  /// \throws InputError where Assimp cannot read the file, or it has neither faces nor points
  ShiftedMesh readOBJ(const std::string& path) const override;
};

}  // namespace pcl_symmetry::apps
