/// A box of six quads, the simplest mesh whose scans are known exactly.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Core>

inline pcl::PolygonMesh boxMesh(const Eigen::Vector3f& half, const Eigen::Vector3f& center = Eigen::Vector3f::Zero()) {
  pcl::PointCloud<pcl::PointXYZ> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const Eigen::Vector3f corner = center + half.cwiseProduct(sign);
    corners.emplace_back(corner.x(), corner.y(), corner.z());
  }
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(corners, mesh.cloud);
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) {
    mesh.polygons.emplace_back();
    mesh.polygons.back().vertices.assign(quad, quad + 4);
  }
  return mesh;
}
