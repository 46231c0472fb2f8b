/// Meshes as PCL has them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>

#include <vector>

#include "pcl/clouds.h"

namespace pcl_symmetry::test {

/// \param polygons lists of the numbers of vertices.
template <typename Polygons>
pcl::PolygonMesh toMesh(const Points& vertices, const Polygons& polygons) {
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(*toCloud(vertices), mesh.cloud);
  for (const auto& polygon : polygons) {
    mesh.polygons.emplace_back();
    mesh.polygons.back().vertices.assign(polygon.begin(), polygon.end());
  }
  return mesh;
}

/// A box of six quads about the origin.
inline pcl::PolygonMesh boxMesh() {
  Points corners(3, 8);
  for (int i = 0; i < 8; ++i) corners.col(i) << (i & 1 ? 1.0f : -1.0f), (i & 2 ? 0.7f : -0.7f), (i & 4 ? 0.4f : -0.4f);
  return toMesh(corners, std::vector<pcl::Indices>{
                             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

}  // namespace pcl_symmetry::test
