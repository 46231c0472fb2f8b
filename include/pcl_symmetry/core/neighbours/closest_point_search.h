#pragma once

#include <memory>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Finds closest points of one fixed point set, many queries at a time.
class ClosestPointSearch {
public:
  using Ptr = std::shared_ptr<ClosestPointSearch>;
  virtual ~ClosestPointSearch() = default;

  /// The closest \p num_neighbours points to each query.
  /// \param queries 3 x M. \param num_neighbours >= 1 and at most the number of points.
  /// \param indices,sq_distances filled with M x num_neighbours values, query by query, nearest first.
  /// Has to be safe to call from several threads at once.
  virtual void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
                      std::vector<float>& sq_distances) const = 0;

  /// The closest point to each query among those within \p max_sq_distance; -1 and infinity where there is none.
  /// \param indices in: M points that are likely to be close, or -1; out: the closest. What a search knows beforehand
  /// spares it most of its way.
  virtual void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                            std::vector<float>& sq_distances) const;
};

/// A FLANN k-d tree over the points (which are copied into the tree).
ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points);

}  // namespace pcl_symmetry
