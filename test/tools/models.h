/// Text of models with known symmetry: a box, what is turned on a lathe, and a tetrahedron that has none.
#pragma once

#include <Eigen/Core>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "shapes/turning_shapes.h"

/// \param polygons lists of the numbers of vertices.
template <typename Polygons>
std::string offText(const Eigen::Matrix3Xd& vertices, const Polygons& polygons) {
  std::ostringstream text;
  text.precision(12);
  text << "OFF\n" << vertices.cols() << ' ' << polygons.size() << " 0\n" << vertices.transpose() << '\n';
  for (const auto& polygon : polygons) {
    text << polygon.size();
    for (const int v : polygon) text << ' ' << v;
    text << '\n';
  }
  return text.str();
}

inline std::string offText(const pcl_symmetry::test::TurningShape& shape) {
  return offText(shape.corners(), shape.triangles);
}

/// A profile (radius, height) turned about z.
inline std::string latheOFF(const std::vector<Eigen::Vector2d>& profile, int num_sides) {
  pcl_symmetry::test::TurningShape shape;
  shape.addLathe(profile, num_sides);
  return offText(shape);
}

/// A vase: closed at the bottom, open at the top.
inline std::string vaseOFF() {
  return latheOFF({{0.001, 0}, {0.5, 0}, {0.8, 0.5}, {0.9, 1.0}, {0.7, 1.6}, {0.3, 2.2}, {0.3, 2.5}, {0.45, 2.7}}, 64);
}

/// \return the corners of a box about the origin: counterclockwise below, then above.
inline Eigen::Matrix3Xd boxCorners(const Eigen::Vector3d& half) {
  Eigen::Matrix3Xd corners(3, 8);
  for (int i = 0; i < 8; ++i)
    corners.col(i) =
        half.cwiseProduct(Eigen::Vector3d((i + 1) & 2 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0));
  return corners;
}

/// \param corners as those of boxCorners().
inline std::string boxOFF(const Eigen::Matrix3Xd& corners) {
  return offText(corners, std::vector<std::array<int, 4>>{
                              {3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 0, 4, 7}});
}

/// A box from -1 -y -z to 1 y z.
inline std::string boxOFF(double y = 1.5, double z = 2.0) {
  return boxOFF(boxCorners({1.0, y, z}));
}

inline std::string tetrahedronOFF() {
  return "OFF\n4 4 6\n0 0 0\n2 0.1 0\n0.4 1.3 0.1\n0.7 0.2 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}
