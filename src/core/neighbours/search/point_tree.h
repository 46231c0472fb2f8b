#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

/// A k-d tree over points in space, made for many exact queries: nodes and coordinates lie in the order in which a
/// query visits them, and a query allocates nothing.
///
/// Points are divided and visited as FLANN's KDTreeSingleIndex does it, and distances are rounded alike: the answers
/// are the same ones, also where several points are equally far away. FLANN leaves out subtrees beyond the plane of a
/// division, this tree those whose bounding box is too far: a point away from the surface looks at half as many leaves.
class PointTree : public ClosestPointSearch {
public:
  /// \param points 3 x N, finite, N >= 1; they are copied.
  explicit PointTree(const PointsRef& points);

  void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override;
  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override;

private:
  /// An inner node or a leaf. The first child of an inner node follows it.
  struct Node {
    /// Corners of the bounding box of its points. The fourth place holds where an inner node is divided: the greatest
    /// coordinate of its first child along the axis, and the least one of its second child.
    std::array<float, 4> low, high;
    std::int32_t link;        ///< inner node: its second child; leaf: its first point
    std::int32_t axis;        ///< of the division
    std::int32_t num_points;  ///< of a leaf; 0: an inner node
  };
  /// A node that a query has put off, and the squared distance of its box.
  struct Pending {
    std::int32_t node;
    float sq_distance;
  };
  struct Box {
    Eigen::Array3f low, high;
  };
  struct Entry {
    Eigen::Vector3f point;
    int index;
  };

  Box divide(std::vector<Entry>& entries, int begin, int end, Box box, int depth);
  static float sqDistance(const Node& node, const Eigen::Vector3f& query);
  template <typename Result>
  void visit(const Eigen::Vector3f& query, std::vector<Pending>& pending, Result& result) const;
  template <typename Result>
  void visitLeaf(const Node& leaf, const Eigen::Vector3f& query, Result& result) const;

  Points points_;                    ///< in the order of the caller
  std::vector<Node> nodes_;          ///< the root first
  std::vector<float> x_, y_, z_;     ///< of the points in the order of the leaves, with room for a whole last vector
  std::vector<std::int32_t> index_;  ///< of these points in the order of the caller
  int depth_ = 0;
};

}  // namespace pcl_symmetry
