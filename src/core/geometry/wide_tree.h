#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/simd.h"
#include "pcl_symmetry/core/point_set.h"

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
  std::vector<Pending> pending() const { return std::vector<Pending>(num_pending_); }

  /// Queries, and for each a node or leaf that may hold its closest point.
  struct Pairs {
    std::vector<std::int32_t> queries, children;
    std::size_t size = 0;

    void makeRoom(std::size_t num_more);
  };

  /// chosen: half of the room for points within the distance
  static constexpr int kMostOfMany = 24;

  /// The points within the distance of a query, in no order. They fill whole vectors.
  struct Within {
    /// derived: points, one more vector that exceeds them, and what is written behind it
    static constexpr int kRoom = 2 * kMostOfMany + 2 * kChildren;
    std::array<float, kRoom> sq_distances;
    std::array<std::int32_t, kRoom> places;
    int size = 0;
  };

  /// What many queries need at a time; used again by the next ones.
  struct Storage {
    Pairs nodes, next, leaves;
    std::vector<Within> within;
  };

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

  /// findClosest() for many queries whose limits are hardly greater than the answers. Level by level, so that no query
  /// waits for the boxes of another.
  /// \pre isSupported()
  /// \param queries 3 x M.
  /// \param closest M, as of findClosest().
  void findClosestOfMany(const OrderedCoordinates& points, const Points& queries, std::vector<Closest>& closest,
                         Storage& storage) const;

  /// \param most how many closest points are wanted, at most as many as there are.
  /// \param[out] places,sq_distances room for them; nearest first.
  /// \return whether the tree with two children has to answer: points are equally far away, so that others may be found,
  /// or in another order; or distances are no numbers.
  bool findNearest(const OrderedCoordinates& points, const float* query, int most, std::vector<Pending>& pending,
                   std::int32_t* places, float* sq_distances) const;

  /// findNearest() for many queries, among the points within a distance of each: all of these are found first, level by
  /// level, and then put in order.
  /// \pre isSupported(); most <= kMostOfMany
  /// \param queries 3 x M.
  /// \param limits M, of which the squared distances count; fastest where about twice as many points are within them as
  /// are wanted.
  /// \param[out] places,sq_distances room for M times as many as are wanted.
  /// \return M values, 1 where findNearest() has to answer: too few or too many points are within the distance, or some
  /// are equally far away.
  std::vector<char> findNearestOfMany(const OrderedCoordinates& points, const Points& queries,
                                      const std::vector<Closest>& limits, int most, std::int32_t* places,
                                      float* sq_distances, Storage& storage) const;

private:
  struct Node {
    std::array<std::array<float, kChildren>, 3> low, high;  ///< of the boxes of the children, axis by axis
    std::array<std::int32_t, kChildren> children;           ///< a node; or -1 - l: leaf l
  };
  struct Leaf {
    std::int32_t first, num_points;
  };

  void findChildren(const Points& queries, const std::vector<Closest>& closest, const Pairs& at, Pairs& nodes,
                    Pairs& leaves) const;
  const Pairs& findLeaves(const Points& queries, const std::vector<Closest>& limits, Storage& storage) const;
  static void addLeaf(const OrderedCoordinates& points, const float* query, Leaf leaf, float sq_limit, Within& within);
  static bool putInOrder(Within& within, int most, std::int32_t* places, float* sq_distances);
  template <typename Result>
  static void visitLeaf(const OrderedCoordinates& points, const float* query, Leaf leaf, Result& result);
  template <typename Result>
  void visit(const OrderedCoordinates& points, const float* query, Pending* pending, Result& result) const;
  std::int32_t add(const std::vector<PointTreeNode>& nodes, const std::vector<Leaf>& ranges, std::int32_t node,
                   std::size_t level);

  std::vector<Node> nodes_;  ///< the root first
  std::vector<Leaf> leaves_;
  std::size_t num_pending_ = 1;
};

}  // namespace pcl_symmetry
