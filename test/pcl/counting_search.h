/// A search of PCL that counts its queries, to prove that it is used.
#pragma once

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <vector>

namespace pcl_symmetry::test {

/// It counts without a lock: a search that is derived from one of PCL's is called from one thread at a time.
class CountingKdTree : public pcl::search::KdTree<pcl::PointXYZ> {
public:
  using Ptr = pcl::shared_ptr<CountingKdTree>;
  using pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch;

  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& indices,
                     std::vector<float>& sq_distances) const override {
    ++num_queries;
    return pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch(point, k, indices, sq_distances);
  }

  mutable int num_queries = 0;
};

}  // namespace pcl_symmetry::test
