#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/closest_point_grid.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

/// The closest neighbors of each point, which prove the answers of most queries that start with a guess.
///
/// A point at a distance d from a query has all points that are closer to the query within 2 d of itself. If its
/// neighbors reach as far as that, one of them is the closest point of all, or it is that point itself.
class NeighborLists {
public:
  static constexpr int kNeighbors = 8;  ///< of each point: floats in a register of AVX2

  /// Whether there are lists for \p num_points points: enough, not so many that filling the lists takes longer than
  /// they save, and the instructions for them.
  static bool isUseful(Eigen::Index num_points);

  /// \pre isUseful(points.cols())
  /// \param points 3 x N.
  /// \param nearest kNeighbors + 1 indices for each point, nearest first, as a search for that point finds them.
  /// \param sq_reach squared distance of the last one of each point.
  NeighborLists(const Points& points, const std::vector<int>& nearest, const std::vector<float>& sq_reach);

  /// A point near a query, and whether no other point is as close; that is not known of all points for which it is
  /// true.
  struct Found {
    int index;
    float sq_distance;
    bool is_closest;
  };

  /// Goes from a guess to a neighbor as long as one is closer to the query, for many queries side by side: each waits
  /// for memory while the others go on.
  /// \param queries 3 x M.
  /// \param guesses M points, or -1: the grid has one.
  std::vector<Found> search(const PointsRef& queries, const std::vector<int>& guesses) const;

private:
  /// A point and its neighbors: two lines of the cache.
  struct alignas(64) List {
    float x[kNeighbors], y[kNeighbors], z[kNeighbors];
    std::uint16_t index[kNeighbors];
    float own_x, own_y, own_z;
    float max_sq_distance;  ///< from a query, so that the list decides
  };
  std::vector<List> lists_;
  ClosestPointGrid grid_;  // where walks without a guess begin
};

/// Nearly the closest points, several times as fast as exact ones: where walks along the lists end, which may be beside
/// the closest point where the surface is thin or ends. For planes that are refined again afterwards.
class NeighborWalk : public ClosestPointSearch {
public:
  /// \param lists of the points; must outlive this object.
  /// \param exact answers search(); must outlive this object.
  NeighborWalk(const NeighborLists& lists, const ClosestPointSearch& exact) : lists_(lists), exact_(exact) {}

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    exact_.search(queries, num_neighbors, indices, sq_distances);
  }
  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override;

private:
  const NeighborLists& lists_;
  const ClosestPointSearch& exact_;
};

}  // namespace pcl_symmetry
