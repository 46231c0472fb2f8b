#include "pcl_symmetry/mesh_sampling.h"

#include "core/geometry/triangles.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed) {
  detail::checkAtLeast("num_points", num_points, 1);
  return detail::withBadArguments([&] {
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    cloud->header = mesh.header;
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    if (!arrays.hasArea()) {
      detail::warnOfNoAnswer("sampleMesh", "mesh: no polygon has an area");
      return cloud;
    }
    const Points points = sampleTriangles(arrays.vertices, arrays.triangles, num_points, seed);
    cloud->resize(points.cols());
    cloud->getMatrixXfMap(3, 4, 0) = points;
    return cloud;
  });
}

MeshSurface meshSurface(const pcl::PolygonMesh& mesh) {
  return detail::withBadArguments([&] {
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    return MeshSurface(arrays.vertices, arrays.triangles);
  });
}

}  // namespace pcl_symmetry
