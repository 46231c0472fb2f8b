#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Finds the closest point to within a cell by one look-up, because a tree is too slow for searches over many poses.
class ClosestPointGrid {
public:
  /// \param points 3 x N, finite, N >= 1.
  /// \param num_cells cells along each side of the cube, >= 2. The cube covers 1.25 radii of the bounding ball.
  /// \throws std::invalid_argument without a point, or for less than two cells.
  ClosestPointGrid(const PointsRef& points, int num_cells);

  /// \return index of the point closest to the center of the cell that contains \p x; for an \p x outside the cube, of
  /// the nearest cell at its border. In a few cells the point is only nearly the closest.
  int closest(const Eigen::Vector3f& x) const {
    const Eigen::Array3i cell = cellOf(x);
    return nearest_[indexOf(cell.x(), cell.y(), cell.z())];
  }

private:
  /// NaN coordinates give the first cell.
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
  std::vector<int> nearest_;  // for each cell, x fastest
};

/// The closest neighbors of each point, which verify the results of most queries that start with a guess.
///
/// All points closer to a query than a point at distance d lie within 2 d of that point. If its neighbors reach that
/// far, the closest point of all is one of them or the point itself.
class NeighborLists {
public:
  static constexpr int kNeighbors = 8;  ///< neighbors of each point: floats in a register of AVX2

  /// Whether lists pay off for \p num_points points: enough points, few enough that filling the lists takes less time
  /// than they save, and a processor with the instructions.
  static bool isUseful(Eigen::Index num_points);

  /// \pre isUseful(points.cols())
  /// \param points 3 x N.
  /// \param nearest kNeighbors + 1 indices for each point, nearest first, as a search for that point finds them.
  /// \param sq_reach squared distance of the last neighbor of each point.
  NeighborLists(const Points& points, const std::vector<int>& nearest, const std::vector<float>& sq_reach);

  /// A point near a query and whether it is verified as the closest; some closest points are not verified.
  struct Found {
    int index;
    float sq_distance;
    bool is_closest;
  };

  /// Walks from a guess to closer neighbors until none is closer to the query, for many queries interleaved, which
  /// hides memory latency.
  /// \param queries 3 x M.
  /// \param guesses M indices of points; -1 = the grid provides one.
  std::vector<Found> search(const PointsRef& queries, const std::vector<int>& guesses) const;

private:
  /// A point and its neighbors: two lines of the cache.
  struct alignas(64) List {
    float x[kNeighbors], y[kNeighbors], z[kNeighbors];
    std::uint16_t index[kNeighbors];
    float own_x, own_y, own_z;
    float max_sq_distance;  ///< greatest squared distance of a query for which the list can verify the result
  };
  std::vector<List> lists_;
  ClosestPointGrid grid_;  // provides the start of walks without a guess
};

/// Approximate closest points, several times as fast as exact ones: the ends of walks along the lists, which may miss
/// the closest point where the surface is thin or ends. For planes that are refined again afterwards.
class NeighborWalk : public ClosestPointSearch {
public:
  /// \param lists neighbor lists of the points; must outlive this object.
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

/// Closest points by FLANN's k-d tree, and by neighbor lists if these verify the result.
class FlannSearch : public ClosestPointSearch {
public:
  /// \param points 3 x N, finite, N >= 1; they are copied.
  explicit FlannSearch(const PointsRef& points);
  ~FlannSearch() override;

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override;
  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override;

  /// Uses FLANN in searchWithin() only where these lists do not verify the result. Results stay the same.
  /// \param lists neighbor lists of the same points; null = none.
  void use(std::shared_ptr<const NeighborLists> lists) { lists_ = std::move(lists); }

private:
  struct Tree;  // the k-d tree of FLANN

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
/// \param search search over points.
/// \return the same search over (points - center) / scale.
ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale);

}  // namespace pcl_symmetry
