/// Meshes made of curved patches: shapes of our own for pictures.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "core/base/constants.h"

namespace pcl_symmetry::apps {

class ParametricMesh {
public:
  /// \param surface takes (u, v) in [0, 1]^2 to an Eigen::Vector3d.
  /// \param num_u,num_v quadrangles along each.
  template <typename Surface>
  void addSurface(int num_u, int num_v, const Surface& surface) {
    const auto first = static_cast<pcl::index_t>(vertices_.size());
    for (int i = 0; i <= num_u; ++i)
      for (int j = 0; j <= num_v; ++j) {
        pcl::PointXYZ vertex;
        vertex.getVector3fMap() = Eigen::Vector3d(surface(double(i) / num_u, double(j) / num_v)).cast<float>();
        vertices_.push_back(vertex);
      }
    for (int i = 0; i < num_u; ++i)
      for (int j = 0; j < num_v; ++j) {
        const pcl::index_t a = first + i * (num_v + 1) + j, b = a + num_v + 1;
        // Two triangles: quadrangles of a curved surface are not planar.
        addTriangle(a, b, b + 1);
        addTriangle(a, b + 1, a + 1);
      }
  }

  /// What the profile sweeps when turned about z.
  /// \param profile radius and height, from end to end.
  void addTurned(const std::vector<Eigen::Vector2d>& profile) {
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
      addSurface(1, 96, [&](double u, double v) {
        const Eigen::Vector2d p = (1.0 - u) * profile[i] + u * profile[i + 1];
        return Eigen::Vector3d(p.x() * std::cos(2.0 * kPi * v), p.x() * std::sin(2.0 * kPi * v), p.y());
      });
  }

  void addBox(const Eigen::AlignedBox3d& box) {
    for (int axis = 0; axis < 3; ++axis)
      for (const Eigen::Vector3d& corner : {box.min(), box.max()})
        addSurface(1, 1, [&](double u, double v) {
          Eigen::Vector3d place(0.0, 0.0, 0.0);
          place[(axis + 1) % 3] = u;
          place[(axis + 2) % 3] = v;
          Eigen::Vector3d point = box.min() + place.cwiseProduct(box.sizes());
          point[axis] = corner[axis];
          return point;
        });
  }

  pcl::PolygonMesh polygonMesh() const {
    pcl::PolygonMesh mesh;
    pcl::toPCLPointCloud2(vertices_, mesh.cloud);
    mesh.polygons = triangles_;
    return mesh;
  }

private:
  void addTriangle(pcl::index_t a, pcl::index_t b, pcl::index_t c) {
    pcl::Vertices triangle;
    triangle.vertices = {a, b, c};
    triangles_.push_back(triangle);
  }

  pcl::PointCloud<pcl::PointXYZ> vertices_;
  std::vector<pcl::Vertices> triangles_;
};

}  // namespace pcl_symmetry::apps
