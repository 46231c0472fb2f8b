/// Meshes with known parts.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/surface_graph.h"
#include "shapes/shapes.h"

namespace pcl_symmetry::test {

struct Mesh {
  Points vertices = Points(3, 0);
  std::vector<std::vector<int>> polygons;

  int add(const Eigen::Vector3f& vertex) {
    vertices.conservativeResize(Eigen::NoChange, vertices.cols() + 1);
    vertices.rightCols<1>() = vertex;
    return static_cast<int>(vertices.cols()) - 1;
  }
  Eigen::Vector3f center(std::size_t polygon) const { return vertices(Eigen::all, polygons[polygon]).rowwise().mean(); }
  SurfaceGraph graph() const { return meshGraph(vertices, polygons); }
};

struct TriangleMesh {
  Points vertices;
  std::vector<Eigen::Vector3i> triangles;

  SurfaceGraph graph() const {
    std::vector<std::vector<int>> polygons;
    for (const Eigen::Vector3i& triangle : triangles) polygons.emplace_back(triangle.begin(), triangle.end());
    return meshGraph(vertices, polygons);
  }
};

/// A box with a corner at the origin.
inline TriangleMesh boxOfTriangles(float x, float y, float z) {
  TriangleMesh mesh{Points(3, 8), {}};
  for (const auto& quad : kBoxQuads)
    for (int k = 2; k < 4; ++k) mesh.triangles.emplace_back(quad[0], quad[k - 1], quad[k]);
  for (int i = 0; i < 8; ++i) mesh.vertices.col(i) << (i & 1 ? x : 0), (i & 2 ? y : 0), (i & 4 ? z : 0);
  return mesh;
}

/// The surface of a set of unit cubes, in quads, outward.
/// \param filled whether the cube with this lowest corner belongs to the body, asked within [0, size)^3.
template <typename Filled>
Mesh voxelMesh(int size, const Filled& filled) {
  const auto inside = [&](const Eigen::Vector3i& c) {
    return (c.array() >= 0).all() && (c.array() < size).all() && filled(c.x(), c.y(), c.z());
  };
  Mesh mesh;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto [entry, is_new] = known.insert({{p.x(), p.y(), p.z()}, static_cast<int>(mesh.vertices.cols())});
    if (is_new) mesh.add(p.cast<float>());
    return entry->second;
  };
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z) {
        const Eigen::Vector3i cube(x, y, z);
        if (!inside(cube)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (const int sign : {-1, 1}) {
            if (inside(cube + sign * Eigen::Vector3i::Unit(axis))) continue;
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3), v = Eigen::Vector3i::Unit((axis + 2) % 3);
            const Eigen::Vector3i corner = sign > 0 ? Eigen::Vector3i(cube + Eigen::Vector3i::Unit(axis)) : cube;
            std::vector<int> quad{vertex(corner), vertex(corner + u), vertex(corner + u + v), vertex(corner + v)};
            if (sign < 0) std::swap(quad[1], quad[3]);
            mesh.polygons.push_back(quad);
          }
      }
  return mesh;
}

/// Two cubes of 8 x 8 x 8 joined by a bar of 2 x 2 x 6 along x.
inline Mesh dumbbell() {
  return voxelMesh(22, [](int x, int y, int z) {
    if (y >= 8 || z >= 8) return false;
    return x < 8 || x >= 14 || (y >= 3 && y < 5 && z >= 3 && z < 5);
  });
}

/// For each point the indices of its \p count nearest other points, nearest first.
inline std::vector<std::vector<int>> neighborsOf(const Points& points, int count) {
  std::vector<int> indices;
  std::vector<float> sq_distances;
  makeFlannSearch(points)->search(points, count + 1, indices, sq_distances);
  std::vector<std::vector<int>> neighbors(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (int k = 0; k <= count; ++k)
      if (indices[i * (count + 1) + k] != i) neighbors[i].push_back(indices[i * (count + 1) + k]);
  for (auto& own : neighbors) own.resize(count);
  return neighbors;
}

}  // namespace pcl_symmetry::test
