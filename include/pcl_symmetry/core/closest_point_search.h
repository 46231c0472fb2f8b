#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Finds the closest points of one fixed point set, for many queries at a time (Section 4.4).
///
/// Derive from it to use a search structure of your own. Implement search(); searchWithin(), which Iterative Symmetric
/// Points calls, has a default. Results are written into vectors of the caller, which repeated searches reuse.
class ClosestPointSearch {
public:
  using Ptr = std::shared_ptr<ClosestPointSearch>;
  virtual ~ClosestPointSearch() = default;

  /// Finds the num_neighbors closest points to each query. Must be safe to call from several threads at once.
  /// \param queries 3 x M, finite, input units.
  /// \param num_neighbors neighbors of each query, >= 1 and at most the number of points.
  /// \param[out] indices M * num_neighbors indices of points, query by query, nearest first; resized by the call.
  /// \param[out] sq_distances squared distances to these points, input units squared; resized by the call.
  virtual void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
                      std::vector<float>& sq_distances) const = 0;

  /// \return the index of the point closest to each of M queries.
  std::vector<int> closest(const PointsRef& queries) const {
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search(queries, 1, indices, sq_distances);
    return indices;
  }

  /// Finds the closest point to each query within a distance. Must be safe to call from several threads at once.
  /// \param queries 3 x M, finite, input units.
  /// \param max_sq_distance greatest squared distance, input units squared.
  /// \param[in,out] indices before the call M points that are likely to be close, or -1; they shorten the search and do
  /// not change its result. After it the closest points, or -1 where none lies within the distance.
  /// \param[out] sq_distances M squared distances, infinity where there is no point; resized by the call.
  virtual void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                            std::vector<float>& sq_distances) const;
};

/// \param points 3 x N, finite, N >= 1; they are copied.
/// \return an exact search by a k-d tree of FLANN. For several neighbors, it is fastest if each query lies near the one
/// before it.
ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points);

/// Makes a search over points (3 x N, finite, N >= 1), as makeFlannSearch() does. The points are those that a
/// computation uses, in input units: distinct ones, and a subset of a large cloud.
using MakeSearch = std::function<ClosestPointSearch::Ptr(const PointsRef& points)>;

}  // namespace pcl_symmetry
