#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// The first triangle that a ray meets.
struct RayHit {
  int triangle = -1;                                        ///< index of the triangle; -1 if the ray meets none
  float distance = std::numeric_limits<float>::infinity();  ///< lengths of the direction
};

/// A bounding volume hierarchy for ray queries. (The tools use Embree; the library does not depend on it.)
class TriangleTree {
public:
  /// \param corners 3 x V, kept by reference.
  /// \param triangles indices into the corners, kept by reference. Rays do not meet triangles without area.
  TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles);

  /// \param direction not zero; its length is the unit of the distances.
  /// \return the closest triangle at a distance in (nearest, farthest).
  RayHit closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest = 0.0f,
                 float farthest = std::numeric_limits<float>::infinity()) const;

  /// \return whether a triangle lies between two points.
  bool blocks(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

private:
  struct Node {
    Eigen::Array3f min, max;
    int first;  // index of its first triangle in order_; of its two children in nodes_ if count = 0
    int count;  // number of triangles of a leaf; 0 for an inner node
  };

  void build(int node, int begin, int end);
  RayHit search(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest, float farthest,
                bool any) const;

  const Points& corners_;
  const std::vector<Eigen::Vector3i>& triangles_;
  Points middles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace pcl_symmetry
