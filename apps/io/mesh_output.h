/// Writes meshes with a value of each vertex.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// Writes a PLY file of the moved vertices, with one more property of type float, and the polygons.
/// \param motion of the vertices; beyond what float resolves they are written in double.
/// \throws InputError where the file cannot be written.
void saveMesh(const std::string& path, const pcl::PolygonMesh& mesh, const Eigen::Isometry3d& motion,
              const std::string& property, const std::vector<float>& values);

/// \throws UsageError unless the extension is that of a PLY file.
void checkMeshExtension(const std::string& path);

}  // namespace pcl_symmetry::apps
