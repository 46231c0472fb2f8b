/// Meshes as PCL has them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>

#include <iterator>

#include "pcl/clouds.h"

namespace pcl_symmetry::test {

/// \param polygons lists of the numbers of vertices.
template <typename Polygons>
pcl::PolygonMesh toMesh(const Points& vertices, const Polygons& polygons) {
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(*toCloud(vertices), mesh.cloud);
  for (const auto& polygon : polygons) {
    mesh.polygons.emplace_back();
    mesh.polygons.back().vertices.assign(std::begin(polygon), std::end(polygon));
  }
  return mesh;
}

/// A box of six quads about the origin.
inline pcl::PolygonMesh boxMesh() {
  Points corners(3, 8);
  for (int i = 0; i < 8; ++i) corners.col(i) << (i & 1 ? 1.0f : -1.0f), (i & 2 ? 0.7f : -0.7f), (i & 4 ? 0.4f : -0.4f);
  return toMesh(corners, kBoxQuads);
}

}  // namespace pcl_symmetry::test
