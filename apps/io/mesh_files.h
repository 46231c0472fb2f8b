/// OBJ and STL files read by Assimp, in a module that is loaded when the first one is.
///
/// Assimp knows 40 formats and takes longer to load than the rest of a tool.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Core>
#include <string>

namespace pcl_symmetry::apps {

/// A mesh whose vertices are minus the shift.
struct ShiftedMesh {
  pcl::PolygonMesh mesh;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Implemented by the module pcl_symmetry_mesh_files.so. Both throw InputError naming the file where they fail.
class MeshFiles {
public:
  virtual ~MeshFiles() = default;
  /// Vertices of exactly equal coordinates are joined: STL repeats them for each face, OBJ for each group.
  virtual pcl::PolygonMesh readSTL(const std::string& path) const = 0;
  /// The vertices of a .obj file without faces are points.
  virtual ShiftedMesh readOBJ(const std::string& path) const = 0;
};

/// Loads the module at the first call.
/// \throws InputError where it is missing or that of another version.
const MeshFiles& meshFiles();

}  // namespace pcl_symmetry::apps
