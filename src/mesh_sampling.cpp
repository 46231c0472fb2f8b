#include "pcl_symmetry/mesh_sampling.h"

#include <pcl/conversions.h>

#include "core/geometry/mesh_sampling.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed) {
  return detail::withBadArguments([&] {
    // PCL's conversions refer to the first point, also where there is none.
    Points vertices(3, 0);
    if (mesh.cloud.width > 0 && mesh.cloud.height > 0) {
      pcl::PointCloud<pcl::PointXYZ> vertex_cloud;
      pcl::fromPCLPointCloud2(mesh.cloud, vertex_cloud);
      vertices = vertex_cloud.getMatrixXfMap(3, 4, 0);
    }
    std::vector<Eigen::Vector3i> triangles;
    for (const pcl::Vertices& polygon : mesh.polygons)
      for (std::size_t i = 2; i < polygon.vertices.size(); ++i)
        triangles.emplace_back(polygon.vertices[0], polygon.vertices[i - 1], polygon.vertices[i]);
    const Points points = sampleTriangles(vertices, triangles, num_points, seed);
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    cloud->header = mesh.header;
    cloud->resize(points.cols());
    cloud->getMatrixXfMap(3, 4, 0) = points;
    return cloud;
  });
}

}  // namespace pcl_symmetry
