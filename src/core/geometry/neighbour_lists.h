#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/geometry/closest_point_grid.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The closest neighbours of each point, with which most queries that come with a guess need no tree.
///
/// A point at a distance d from a query has all points that are closer to the query within 2 d of itself. If its
/// neighbours reach as far as that, one of them is the closest point of all, or it is that point itself.
class NeighbourLists {
public:
  static constexpr int kNeighbours = 8;  ///< of each point. derived: floats in a register of AVX2
  /// chosen: 128 bytes a point; beyond, filling the lists takes longer than they save
  static constexpr Eigen::Index kMostPoints = 50'000;
  /// Queries that walk side by side. chosen: half as many wait for memory more often, twice as many leave the first
  /// cache
  static constexpr int kTogether = 256;

  /// Whether there are lists for \p num_points points: enough, not too many, and the instructions for them.
  static bool isUseful(Eigen::Index num_points);

  /// The grid in which walks without a guess begin.
  /// \param points 3 x N.
  static ClosestPointGrid starts(const Points& points);

  /// \pre isUseful(points.cols())
  /// \param points 3 x N.
  /// \param nearest kNeighbours + 1 indices for each point, nearest first, as a search for that point finds them.
  /// \param sq_reach squared distance of the last one of each point.
  NeighbourLists(const Points& points, const std::vector<int>& nearest, const std::vector<float>& sq_reach);

  /// The same with a grid that was made before.
  /// \param starts of the same points.
  /// \param num_threads 0 = one per core.
  NeighbourLists(ClosestPointGrid starts, const Points& points, const std::vector<int>& nearest,
                 const std::vector<float>& sq_reach, int num_threads);

  /// Walks from a guess of the closest point to a neighbour as long as one is closer to the query, for many queries at
  /// a time: each waits for memory while the others go on.
  /// \param queries 3 x M.
  /// \param[in,out] indices M guesses; after the call the points where the walks end.
  /// \param[out] sq_distances of these points.
  /// \param[out] is_closest whether no other point is as close; not told of all points of which it is true.
  void walk(const PointsRef& queries, int* indices, float* sq_distances, char* is_closest) const;

  /// A point near a query, to begin a walk at.
  int start(const Eigen::Vector3f& query) const { return grid_.closest(query); }

private:
  /// A point and its neighbours: two lines of the cache.
  struct alignas(64) List {
    float x[kNeighbours], y[kNeighbours], z[kNeighbours];
    std::uint16_t index[kNeighbours];
    float own_x, own_y, own_z;
    float most_sq_distance;  ///< from a query, so that the list decides
  };
  static_assert(kMostPoints <= std::numeric_limits<std::uint16_t>::max());

  void fill(std::size_t i, const Points& points, const std::vector<int>& nearest, float sq_reach);
  void walkSome(const PointsRef& queries, int* indices, float* sq_distances, char* is_closest) const;

  std::unique_ptr<List[]> lists_;  // each is set by the thread that fills it
  ClosestPointGrid grid_;
};

}  // namespace pcl_symmetry
