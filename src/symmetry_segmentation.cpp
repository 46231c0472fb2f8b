#include "pcl_symmetry/impl/symmetry_segmentation.hpp"

#include <pcl/conversions.h>
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

namespace pcl_symmetry {

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  // PCL's conversions refer to the first point, also where there is none.
  Points vertices(3, 0);
  if (mesh.cloud.width > 0 && mesh.cloud.height > 0) {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    pcl::fromPCLPointCloud2(mesh.cloud, cloud);
    vertices = cloud.getMatrixXfMap(3, 4, 0);
  }
  std::vector<std::vector<int>> polygons;
  for (const pcl::Vertices& polygon : mesh.polygons)
    polygons.emplace_back(polygon.vertices.begin(), polygon.vertices.end());
  return meshGraph(vertices, polygons);
}

}  // namespace pcl_symmetry

PCL_INSTANTIATE(SymmetrySegmentation, PCL_XYZ_POINT_TYPES)
