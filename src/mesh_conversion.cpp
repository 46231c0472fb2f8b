#include "mesh_conversion.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace pcl_symmetry {

MeshArrays toArrays(const pcl::PolygonMesh& mesh) {
  MeshArrays arrays;
  arrays.vertices.resize(3, 0);
  // PCL's conversions refer to the first point, also where there is none.
  if (mesh.cloud.width > 0 && mesh.cloud.height > 0) {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    pcl::fromPCLPointCloud2(mesh.cloud, cloud);
    arrays.vertices = cloud.getMatrixXfMap(3, 4, 0);
  }
  for (const pcl::Vertices& polygon : mesh.polygons) {
    for (const auto index : polygon.vertices) {
      const auto vertex = static_cast<Eigen::Index>(index);
      check(vertex >= 0 && vertex < arrays.vertices.cols(), "vertex of a polygon", vertex, "one that the mesh has");
    }
    const std::vector<int>& corners = arrays.polygons.emplace_back(polygon.vertices.begin(), polygon.vertices.end());
    for (std::size_t i = 2; i < corners.size(); ++i)
      arrays.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
  }
  return arrays;
}

bool MeshArrays::hasArea() const {
  return std::any_of(triangles.begin(), triangles.end(), [&](const Eigen::Vector3i& triangle) {
    const Eigen::Vector3d a = vertices.col(triangle[0]).cast<double>();
    const Eigen::Vector3d b = vertices.col(triangle[1]).cast<double>();
    const Eigen::Vector3d c = vertices.col(triangle[2]).cast<double>();
    const double doubled_area = (b - a).cross(c - a).norm();
    return std::isfinite(doubled_area) && doubled_area > 0.0;
  });
}

}  // namespace pcl_symmetry
