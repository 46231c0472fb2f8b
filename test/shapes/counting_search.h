/// A search that counts what it is asked, to prove that it is used.
#pragma once

#include <atomic>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::test {

struct AskedSearch {
  std::atomic<int> num_made{0};
  std::atomic<Eigen::Index> num_points{0};  ///< of the last one made
  std::atomic<Eigen::Index> num_queries{0};

  /// \return FLANN's search, counted here. This object must outlive it.
  MakeSearch make() {
    struct Counting : ClosestPointSearch {
      Counting(const PointsRef& points, AskedSearch& asked) : all(makeFlannSearch(points)), asked_(asked) {}
      void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
                  std::vector<float>& sq_distances) const override {
        asked_.num_queries += queries.cols();
        all->search(queries, num_neighbors, indices, sq_distances);
      }
      Ptr all;
      AskedSearch& asked_;
    };
    return [this](const PointsRef& points) {
      ++num_made;
      num_points = points.cols();
      return std::make_shared<Counting>(points, *this);
    };
  }
};

}  // namespace pcl_symmetry::test
