#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/neighbour_lists.h"
#include "core/geometry/wide_tree.h"
#include "pcl_symmetry/core/closest_point_search.h"

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

  /// From now on, searchWithin() uses these lists where it has a guess. The answers stay the same.
  /// \param lists of the same points.
  void use(NeighbourLists lists) { lists_ = std::move(lists); }

  /// \return what use() was given; null = nothing.
  const NeighbourLists* lists() const { return lists_ ? &*lists_ : nullptr; }

private:
  using Node = PointTreeNode;
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

  /// The closest point to a query, or a point or none that it has to be closer than.
  struct Match {
    int index;
    float sq_distance;
  };
  struct Storage {
    std::vector<Pending> pending;
    std::vector<WideTree::Pending> wide;
    WideTree::Storage many;
    std::vector<int> open;  ///< queries that the lists do not decide
    std::vector<WideTree::Closest> found;
  };

  Box divide(std::vector<Entry>& entries, std::vector<int>& places, int begin, int end, Box box, int depth);
  static float sqDistance(const Node& node, const Eigen::Vector3f& query);
  template <typename Result>
  void visit(const Eigen::Vector3f& query, std::vector<Pending>& pending, Result& result) const;
  Storage storage() const;
  Match closest(const Eigen::Vector3f& query, Match start, Storage& storage) const;
  Match closest(const Eigen::Vector3f& query, Match start, const WideTree::Closest& found, Storage& storage) const;
  void nearest(const Eigen::Vector3f& query, int num_neighbours, int* indices, float* sq_distances,
               Storage& storage) const;
  void nearestOfMany(const PointsRef& queries, int num_neighbours, int* indices, float* sq_distances,
                     Storage& storage) const;
  void closestByWalks(const PointsRef& queries, const int* guesses, std::vector<Match>& matches,
                      Storage& storage) const;
  template <typename Result>
  void visitLeaf(const Node& leaf, const Eigen::Vector3f& query, Result& result) const;

  Points points_;                    ///< in the order of the caller
  std::vector<Node> nodes_;          ///< the root first
  std::optional<WideTree> wide_;     ///< where the processor has wide registers
  OrderedCoordinates ordered_;       ///< of the points
  std::vector<std::int32_t> index_;  ///< of these points in the order of the caller
  int depth_ = 0;
  std::optional<NeighbourLists> lists_;
};

}  // namespace pcl_symmetry
