/// Meshes as PCL has them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <array>

namespace pcl_symmetry::test {

/// A box of 2 x 1.4 x 0.8 about the origin, of six quads.
inline pcl::PolygonMesh boxMesh() {
  pcl::PointCloud<pcl::PointXYZ> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1.0f : -1.0f, i & 2 ? 0.7f : -0.7f, i & 4 ? 0.4f : -0.4f);
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(corners, mesh.cloud);
  for (const auto& quad : {std::array<pcl::index_t, 4>{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}}) {
    mesh.polygons.emplace_back();
    mesh.polygons.back().vertices.assign(quad.begin(), quad.end());
  }
  return mesh;
}

}  // namespace pcl_symmetry::test
