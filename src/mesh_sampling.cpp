#include "pcl_symmetry/mesh_sampling.h"

#include <pcl/conversions.h>

#include "pcl_symmetry/core/mesh_sampling.h"
#include "pcl_symmetry/impl/bad_argument.hpp"

namespace pcl_symmetry {

pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed) {
  return withBadArguments([&] {
    pcl::PointCloud<pcl::PointXYZ> vertices;
    pcl::fromPCLPointCloud2(mesh.cloud, vertices);
    std::vector<Eigen::Vector3i> triangles;
    for (const pcl::Vertices& polygon : mesh.polygons)
      for (std::size_t i = 2; i < polygon.vertices.size(); ++i)
        triangles.emplace_back(polygon.vertices[0], polygon.vertices[i - 1], polygon.vertices[i]);
    const Points points = sampleTriangles(vertices.getMatrixXfMap(3, 4, 0), triangles, num_points, seed);
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    cloud->header = mesh.header;
    cloud->resize(points.cols());
    cloud->getMatrixXfMap(3, 4, 0) = points;
    return cloud;
  });
}

}  // namespace pcl_symmetry
