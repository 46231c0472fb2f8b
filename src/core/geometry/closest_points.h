#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/neighbor_lists.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

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

/// A search in a moved and scaled frame.
/// \param search over points.
/// \return the same search over (points - center) / scale.
ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale);

/// A search among some of the points of another one.
/// \param search over all points.
/// \param num_points of all.
/// \param kept indices of different points; the result counts in these.
ClosestPointSearch::Ptr among(ClosestPointSearch::Ptr search, std::size_t num_points, const std::vector<int>& kept);

}  // namespace pcl_symmetry
