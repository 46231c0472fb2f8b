/// Meshes and clouds with a value for each face, vertex or point.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "io/shape_input.h"

namespace pcl_symmetry::apps {

/// Writes the segments of a shape.
/// \param path .seg: the labels of a mesh, one whole number per line, as in the Princeton Segmentation Benchmark. .pcd
/// or .ply of a cloud: all its fields and `label` (unsigned; 4294967295 for none). .pcd of a mesh: the centers of its
/// faces with `label`. .ply of a mesh: its faces with `label` and a color each.
/// \param labels one per face of a mesh or point of a cloud; negative = none.
void saveLabeled(const std::string& path, const Shape& shape, const std::vector<int>& labels);

/// Writes a PLY file with the moved vertices, one more property of type float, and the polygons.
/// \param motion motion of the vertices; if float does not resolve them, they are written in double.
/// \throws InputError if the file cannot be written.
void saveMesh(const std::string& path, const pcl::PolygonMesh& mesh, const Eigen::Isometry3d& motion,
              const std::string& property, const std::vector<float>& values);

}  // namespace pcl_symmetry::apps
