#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The closest point to within a cell, by one look-up. A search over many poses asks far too often for a tree.
class ClosestPointGrid {
public:
  /// \param points 3 x N, finite, N >= 1.
  /// \param num_cells cells along each side of the cube, >= 2. The cube covers 1.25 radii of the bounding ball.
  /// \throws std::invalid_argument without a point, or for less than two cells.
  ClosestPointGrid(const PointsRef& points, int num_cells);

  /// \return index of the point closest to the center of the cell that contains \p x; for an \p x outside the cube, of
  /// the nearest cell at its border. A few cells have a point that is only nearly the closest.
  int closest(const Eigen::Vector3f& x) const {
    const Eigen::Array3i cell = cellOf(x);
    return nearest_[indexOf(cell.x(), cell.y(), cell.z())];
  }

private:
  /// The first cell for coordinates that are no numbers.
  Eigen::Array3i cellOf(const Eigen::Vector3f& x) const {
    const auto cell = [&](int k) {
      return static_cast<int>(std::min(last_, std::max(0.0f, (x[k] - origin_[k]) / cell_size_)));
    };
    return {cell(0), cell(1), cell(2)};
  }
  std::size_t indexOf(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n_ + y) * n_ + x; }

  int n_;  // cells along each side
  float cell_size_;
  float last_;                // greatest coordinate inside the cube, in cells
  Eigen::Vector3f origin_;    // corner of the cube
  std::vector<int> nearest_;  // of each cell, x fastest
};

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

  /// A point near a query, and whether it is known to be the closest; some closest points are not known to be.
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

/// Closest points by FLANN's k-d tree, and by lists of neighbors where these prove the answer.
class FlannSearch : public ClosestPointSearch {
public:
  /// \param points 3 x N, finite, N >= 1; they are copied.
  explicit FlannSearch(const PointsRef& points);
  ~FlannSearch() override;

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override;
  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override;

  /// From now on, searchWithin() asks FLANN only where these lists do not prove the answer. The answers stay the same.
  /// \param lists of the same points; null = none.
  void use(std::shared_ptr<const NeighborLists> lists) { lists_ = std::move(lists); }

private:
  struct Tree;  // of FLANN

  Points points_;
  std::unique_ptr<Tree> tree_;
  std::shared_ptr<const NeighborLists> lists_;
};

/// The closest point of each of many queries.
struct ClosestPoints {
  std::vector<int> index;
  std::vector<float> sq_distances;
};

/// \param queries 3 x M.
ClosestPoints closestPoints(const ClosestPointSearch& search, const PointsRef& queries, int num_threads);

/// A search in a moved and scaled frame.
/// \param search over points.
/// \return the same search over (points - center) / scale.
ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale);

}  // namespace pcl_symmetry
