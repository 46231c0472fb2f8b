#include "pcl_symmetry/core/closest_point_search.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_symmetry {

namespace {

/// FLANN's view of a search for one point: keeps the closest of all points that it is shown.
class ClosestResult : public flann::ResultSet<float> {
public:
  ClosestResult(int index, float sq_distance) : index_(index), sq_distance_(sq_distance) {}

  bool full() const override { return true; }
  void addPoint(float sq_distance, std::size_t index) override {
    if (sq_distance >= sq_distance_) return;
    sq_distance_ = sq_distance;
    index_ = static_cast<int>(index);
  }
  float worstDist() const override { return sq_distance_; }

  int index() const { return index_; }

private:
  int index_;
  float sq_distance_;
};

constexpr int kPointsPerLeaf = 10;  // points; chosen: FLANN's default

class FlannSearch : public ClosestPointSearch {
public:
  explicit FlannSearch(const PointsRef& points)
      : points_(points),
        index_(flann::Matrix<float>(points_.data(), points_.cols(), 3),
               flann::KDTreeSingleIndexParams(kPointsPerLeaf, true)) {
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

  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override {
    const flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED, 0.0f, true);
    // FLANN accepts points strictly closer than the limit.
    const float limit = std::nextafter(max_sq_distance, std::numeric_limits<float>::infinity());
    sq_distances.resize(indices.size());
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
      const float guessed = indices[i] < 0 ? limit : (points_.col(indices[i]) - queries.col(i)).squaredNorm();
      ClosestResult closest(guessed < limit ? indices[i] : -1, std::min(guessed, limit));
      index_.findNeighbors(closest, queries.col(i).data(), params);
      indices[i] = closest.index();
      sq_distances[i] = indices[i] < 0 ? std::numeric_limits<float>::infinity() : closest.worstDist();
    }
  }

private:
  Points points_;
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> index_;
};

}  // namespace

void ClosestPointSearch::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                                      std::vector<float>& sq_distances) const {
  search(queries, 1, indices, sq_distances);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (sq_distances[i] <= max_sq_distance) continue;
    indices[i] = -1;
    sq_distances[i] = std::numeric_limits<float>::infinity();
  }
}

ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points) {
  return std::make_shared<FlannSearch>(points);
}

}  // namespace pcl_symmetry
