#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/simd.h"

namespace pcl_symmetry {

/// An inner node or a leaf of a k-d tree over points. The first child of an inner node follows it.
struct PointTreeNode {
  /// Corners of the bounding box of its points. The fourth place holds where an inner node is divided: the greatest
  /// coordinate of its first child along the axis, and the least one of its second child.
  std::array<float, 4> low, high;
  std::int32_t link;        ///< inner node: its second child; leaf: its first point
  std::int32_t axis;        ///< of the division
  std::int32_t num_points;  ///< of a leaf; 0: an inner node
};

/// The coordinates of points in the order of the leaves, with room for a whole last vector.
struct OrderedCoordinates {
  std::vector<float> x, y, z;
};

/// The same tree with eight children a node, whose boxes are compared with a query at once: a query takes three steps
/// from the root to a leaf where two children take ten, and each step waits for the one before.
///
/// Its nodes are visited in another order than those of the tree with two children, so that another one of several
/// points equally far away may be found: a query says where that has happened.
class WideTree {
public:
  static constexpr int kChildren = 8;  ///< derived: floats in a register of AVX2

  /// Whether the processor has the instructions that the queries need.
  static bool isSupported();

  /// \param nodes of the tree with two children, the root first.
  explicit WideTree(const std::vector<PointTreeNode>& nodes);

  /// Storage of a query: nodes that it has put off, and the squared distances of their boxes.
  struct Pending {
    std::int32_t child;
    float sq_distance;
  };
  /// \return as much as a query needs.
  std::vector<Pending> storage() const { return std::vector<Pending>(num_pending_); }

  /// The closest of the points that are strictly closer than a distance.
  struct Closest {
    float sq_distance;        ///< before the query: the limit
    std::int32_t place = -1;  ///< in the order of the leaves; -1: none is closer
    bool is_tied = false;     ///< another point is as far away
  };

  /// \pre isSupported()
  /// \param query three coordinates.
  void findClosest(const OrderedCoordinates& points, const float* query, std::vector<Pending>& pending,
                   Closest& closest) const;

  /// \param most how many closest points are wanted, at most as many as there are.
  /// \param[out] places,sq_distances room for them; nearest first.
  /// \return whether the tree with two children has to answer: points are equally far away, so that others may be found,
  /// or in another order; or distances are no numbers.
  bool findNearest(const OrderedCoordinates& points, const float* query, int most, std::vector<Pending>& pending,
                   std::int32_t* places, float* sq_distances) const;

private:
  struct Node {
    std::array<std::array<float, kChildren>, 3> low, high;  ///< of the boxes of the children, axis by axis
    std::array<std::int32_t, kChildren> children;           ///< a node; or -1 - l: leaf l
  };
  struct Leaf {
    std::int32_t first, num_points;
  };

  template <typename Result>
  void visit(const OrderedCoordinates& points, const float* query, Pending* pending, Result& result) const;
  std::int32_t add(const std::vector<PointTreeNode>& nodes, const std::vector<Leaf>& ranges, std::int32_t node,
                   std::size_t level);

  std::vector<Node> nodes_;  ///< the root first
  std::vector<Leaf> leaves_;
  std::size_t num_pending_ = 1;
};

}  // namespace pcl_symmetry
