/// Reads clouds and meshes from files, and rejects invalid ones with one clear line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"
#include "io/exact_coordinates.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/scalar_grid.h"

namespace pcl_symmetry::apps {

/// The extensions of files that loadShape() reads, for help and messages.
inline const char* const kShapeFiles = ".pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv";

/// The extensions of files taken from folders; there, .txt and .csv files often hold other things.
inline const char* const kShapeFilesOfFolders = ".pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts or .asc";

/// The content of a file. Points may be non-finite, as scanners write them.
struct Shape {
  pcl::PCLPointCloud2 cloud;             ///< all fields of the file, input frame; the vertices of a mesh
  Cloud::Ptr points;                     ///< the coordinates minus the shift, same order and organization
  std::optional<pcl::PolygonMesh> mesh;  ///< polygons of any size >= 3, indices checked; minus the shift
  /// The vector that was subtracted from points and mesh; zero unless the file's coordinates have more digits than
  /// float holds.
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Vector4f sensor_origin = Eigen::Vector4f::Zero();  ///< input frame
  Eigen::Quaternionf sensor_orientation = Eigen::Quaternionf::Identity();
  std::vector<std::string> left_out;  ///< further content of the file, such as lists of vertices, which is not read
};

/// \param path a file of kShapeFiles, in upper or lower case, or "-" for standard input. The kind of standard input,
/// and of a pipe without extension, is recognized by the content
/// \throws InputError naming the file, what is wrong and the rule
Shape loadShape(const std::string& path);

/// \return whether the name ends in one of kShapeFilesOfFolders, in upper or lower case
bool hasShapeExtension(const std::string& path);

/// \return the extension of shape files with such content, such as ".pcd"; empty if it is of no known kind.
std::string extensionOfContent(const std::string& content);

/// \return the mesh on which a volume has the value.
/// \throws InputError naming the file if there is no such surface.
Shape surfaceOf(const std::string& path, const ScalarGrid& volume, double value);

/// \param indices receives the indices of these points in the cloud, unless it is null.
/// \return 3 x N, the finite points of a cloud, same order.
Points finitePoints(const Cloud& cloud, std::vector<std::size_t>* indices = nullptr);

}  // namespace pcl_symmetry::apps
