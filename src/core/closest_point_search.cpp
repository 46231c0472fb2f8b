#include "pcl_symmetry/core/closest_point_search.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

namespace pcl_symmetry {

namespace {

class FlannSearch : public ClosestPointSearch {
public:
  explicit FlannSearch(const PointsRef& points)
      : points_(points),
        index_(flann::Matrix<float>(points_.data(), points_.cols(), 3), flann::KDTreeSingleIndexParams(10, true)) {
    index_.buildIndex();
  }

  void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    const std::size_t num_queries = queries.cols();
    indices.resize(num_queries * num_neighbours);
    sq_distances.resize(num_queries * num_neighbours);
    if (num_queries == 0) return;
    const flann::Matrix<float> query(const_cast<float*>(queries.data()), num_queries, 3,
                                     queries.outerStride() * sizeof(float));
    flann::Matrix<int> index(indices.data(), num_queries, num_neighbours);
    flann::Matrix<float> sq_distance(sq_distances.data(), num_queries, num_neighbours);
    flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED, 0.0f, true);
    params.cores = 1;
    index_.knnSearch(query, index, sq_distance, num_neighbours, params);
  }

private:
  Points points_;
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> index_;
};

}  // namespace

ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points) {
  return std::make_shared<FlannSearch>(points);
}

}  // namespace pcl_symmetry
