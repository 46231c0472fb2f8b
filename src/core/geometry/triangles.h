/// Triangles of a mesh: the finite ones, samples of them, and a tree that finds the closest one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The first triangle that a ray meets.
struct RayHit {
  int triangle = -1;                                        ///< index of the triangle; -1 if the ray meets none
  float distance = std::numeric_limits<float>::infinity();  ///< in lengths of the direction of the ray
};

/// The point of a surface that is closest to another point.
struct ClosestOnTriangles {
  int triangle = -1;  ///< index of the triangle; -1 if none is close enough
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float sq_distance = std::numeric_limits<float>::infinity();
};

/// A bounding volume hierarchy for rays and closest points. (The tools use Embree; the library does not depend on it.)
///
/// A node has four children and a leaf four triangles, stored side by side, so that vector instructions test four at
/// once. Each lane takes the same steps as scalar code.
class TriangleTree {
public:
  /// \param corners 3 x V.
  /// \param triangles indices into the corners. Rays do not meet triangles without area.
  TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles);

  /// \param direction not zero; its length is the unit of the distances.
  /// \return the first triangle beyond the distance \p nearest.
  RayHit closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest = 0.0f) const {
    return search(origin, direction, nearest, std::numeric_limits<float>::infinity(), false);
  }

  /// \return whether a triangle lies between two points.
  bool blocks(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
    return search(from, to - from, 0.0f, 1.0f, true).triangle >= 0;
  }

  /// \param sq_reach greatest squared distance of the closest point; smaller is faster.
  /// \return the exact closest point on the triangles, including those without area.
  ClosestOnTriangles closestTo(const Eigen::Vector3f& x, float sq_reach = std::numeric_limits<float>::infinity()) const;

private:
  static constexpr int kWidth = 4;  // floats in the smallest vector register of current processors
  using Lanes = float __attribute__((vector_size(kWidth * sizeof(float))));
  using Vectors = std::array<Lanes, 3>;

  struct Node {
    Lanes box[2][3];       // lower and upper bounds of the children, by axis
    int child[kWidth];     // index of a node; ~index of a leaf
    int num_children = 0;  // the lanes behind them are not set
  };
  /// Triangles a, a + u, a + v. Lanes without a triangle have no area.
  struct Leaf {
    Vectors a, u, v;
    int triangle[kWidth];
    int size = 0;
  };
  struct Ray {
    Eigen::Vector3f origin, direction, inverse;
    int side[3];  // side of a box, by axis, that the ray enters through: 0 = lower, 1 = upper
    float nearest;
  };

  struct Builder;

  RayHit search(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest, float farthest,
                bool any) const;
  static void distancesTo(const Node& node, const Ray& ray, float farthest, Lanes& near, Lanes& far);
  static Lanes distancesTo(const Leaf& leaf, const Ray& ray);
  static Vectors closestPoints(const Leaf& leaf, const Vectors& x);

  static Vectors same(const float* x) { return {Lanes{} + x[0], Lanes{} + x[1], Lanes{} + x[2]}; }
  static Vectors minus(const Vectors& x, const Vectors& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
  static Lanes dot(const Vectors& x, const Vectors& y) { return x[0] * y[0] + (x[1] * y[1] + x[2] * y[2]); }
  static Vectors cross(const Vectors& x, const Vectors& y) {
    return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  }

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

/// \return the triangles whose vertices are finite.
/// \throws std::invalid_argument for an index out of range.
std::vector<Eigen::Vector3i> finiteTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles);

/// Points spread evenly over triangles: one in each of num_points equal shares of the total area.
/// \param vertices 3 x V, input units.
/// \param triangles indices into the vertices; triangles with a vertex that is not finite are left out.
/// \param num_points >= 1.
/// \return 3 x num_points, in the order of the triangles.
/// \throws std::invalid_argument for an index out of range, or a total area of zero.
Points sampleTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles, int num_points,
                       std::uint64_t seed = 1);

/// The borders of a mesh: edges of only one triangle, identified by the positions of their ends, because files repeat
/// vertices.
/// \param triangles indices of finite vertices.
/// \return indices of vertices.
std::vector<std::pair<int, int>> openEdges(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles);

}  // namespace pcl_symmetry
