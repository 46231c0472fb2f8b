/// The points that stand for a file: those of a cloud, or points spread over a mesh.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>

#include "pcl_symmetry/mesh_sampling.h"
#include "shape_input.h"

namespace pcl_symmetry::apps {

/// \param mesh_points spread over a mesh. \return the points with the pose of their sensor; of a cloud maybe not
/// finite. \throws InputError naming the file.
inline pcl::PointCloud<pcl::PointXYZ>::Ptr loadInputCloud(const std::string& path, int mesh_points) {
  const Shape shape = loadShape(path);
  if (!shape.mesh) {
    shape.points->sensor_origin_ = shape.sensor_origin;
    shape.points->sensor_orientation_ = shape.sensor_orientation;
    return shape.points;
  }
  try {
    const auto cloud = sampleMesh(*shape.mesh, mesh_points);
    if (cloud->empty()) throw InputError(path + ": no polygon has an area");
    return cloud;
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(path + ": " + error.detailedMessage());
  }
}

}  // namespace pcl_symmetry::apps
