#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Where a ray first meets a triangle.
struct RayHit {
  int triangle = -1;  ///< -1: nowhere
  float distance = std::numeric_limits<float>::infinity();
};

/// A bounding volume hierarchy that tells what rays meet. (The tools have Embree; the library goes without.)
class TriangleTree {
public:
  /// \param corners,triangles are kept by reference. Triangles without area are met by no ray.
  TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles);

  /// \param direction of any length, which is the unit of the distances.
  /// \return the closest triangle at a distance in (nearest, farthest).
  RayHit closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest = 0.0f,
                 float farthest = std::numeric_limits<float>::infinity()) const;

  /// \return whether any triangle lies between two points.
  bool blocks(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

private:
  struct Node {
    Eigen::Array3f min, max;
    int first;  ///< of its triangles in order_; of its two children where count = 0
    int count;
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
