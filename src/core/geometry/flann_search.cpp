#include "core/geometry/flann_search.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The closest of all points that FLANN shows it.
class ClosestPoint : public flann::ResultSet<float> {
public:
  ClosestPoint(int index, float sq_distance) : index_(index), sq_distance_(sq_distance) {}

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

/// Several of the closest points that FLANN shows it, nearest first.
class NearestPoints : public flann::ResultSet<float> {
public:
  NearestPoints(int* indices, float* sq_distances, int most)
      : indices_(indices), sq_distances_(sq_distances), most_(most) {}

  bool full() const override { return size_ == most_; }
  void addPoint(float sq_distance, std::size_t index) override {
    if (sq_distance >= worst_) return;
    if (size_ < most_) ++size_;
    int i = size_ - 1;
    for (; i > 0 && sq_distances_[i - 1] > sq_distance; --i) {
      sq_distances_[i] = sq_distances_[i - 1];
      indices_[i] = indices_[i - 1];
    }
    sq_distances_[i] = sq_distance;
    indices_[i] = static_cast<int>(index);
    if (size_ == most_) worst_ = sq_distances_[most_ - 1];
  }
  float worstDist() const override { return worst_; }

private:
  int* indices_;
  float* sq_distances_;
  int most_, size_ = 0;
  float worst_ = std::numeric_limits<float>::max();
};

/// All points within a distance, in any order, and their coordinates.
class PointsWithin : public flann::ResultSet<float> {
public:
  explicit PointsWithin(const Points& points) : points_(points) {}

  void start(float sq_distance) {
    sq_distance_ = sq_distance;
    index.clear();
    for (auto& coordinates : x) coordinates.clear();
  }
  bool full() const override { return true; }
  void addPoint(float, std::size_t i) override {
    index.push_back(static_cast<int>(i));
    for (int axis = 0; axis < 3; ++axis) x[axis].push_back(points_(axis, static_cast<Eigen::Index>(i)));
  }
  float worstDist() const override { return sq_distance_; }

  std::vector<int> index;
  std::vector<float> x[3];

private:
  const Points& points_;
  float sq_distance_ = 0.0f;
};

PCL_SYMMETRY_MULTIVERSION
void sqDistancesFrom(const float* query, const float* x, const float* y, const float* z, int size,
                     float* sq_distances) {
  const float qx = query[0], qy = query[1], qz = query[2];
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float dx = qx - x[i], dy = qy - y[i], dz = qz - z[i];
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
  }
}

/// \param[out] ranks of each value, how many are smaller.
PCL_SYMMETRY_MULTIVERSION
void ranksOf(const float* values, int size, int* ranks) {
  for (int i = 0; i < size; ++i) {
    const float own = values[i];
    int smaller = 0;
    for (int j = 0; j < size; ++j) smaller += values[j] < own ? 1 : 0;
    ranks[i] = smaller;
  }
}

/// The nearest of some points that FLANN has found around a group of queries.
class NearestOfGroup {
public:
  explicit NearestOfGroup(const Points& points) : around(points) {}

  PointsWithin around;

  /// \param sq_limit all points within this of the query are among those around.
  /// \return whether indices and sq_distances are FLANN's answer: not where too few points are within the limit, or where
  /// several are equally far away, so that FLANN chooses between them.
  bool find(const float* query, float sq_limit, int count, int* indices, float* sq_distances) {
    const auto size = static_cast<int>(around.index.size());
    if (static_cast<int>(sq_.size()) < size) {
      for (auto* values : {&sq_, &sq_near_}) values->resize(around.index.size());
      for (auto* values : {&near_, &ranks_}) values->resize(around.index.size());
    }
    sqDistancesFrom(query, around.x[0].data(), around.x[1].data(), around.x[2].data(), size, sq_.data());
    std::size_t num_near = 0;
    for (int i = 0; i < size; ++i) {
      near_[num_near] = around.index[static_cast<std::size_t>(i)];
      sq_near_[num_near] = sq_[static_cast<std::size_t>(i)];
      num_near += sq_[static_cast<std::size_t>(i)] <= sq_limit ? 1 : 0;
    }
    ranksOf(sq_near_.data(), static_cast<int>(num_near), ranks_.data());
    int num_ranks = 0, sum_of_ranks = 0;  // of the wanted ones: all different, where there is no tie
    for (std::size_t i = 0; i < num_near; ++i) {
      if (ranks_[i] >= count) continue;
      indices[ranks_[i]] = near_[i];
      sq_distances[ranks_[i]] = sq_near_[i];
      ++num_ranks;
      sum_of_ranks += ranks_[i];
    }
    return num_ranks == count && sum_of_ranks == count * (count - 1) / 2;
  }

private:
  std::vector<float> sq_, sq_near_;
  std::vector<int> near_, ranks_;
};

}  // namespace

struct FlannSearch::Tree {
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index;
  flann::SearchParams params{flann::FLANN_CHECKS_UNLIMITED, 0.0f, true};
};

FlannSearch::FlannSearch(const PointsRef& points)
    : points_(points),
      tree_(new Tree{{flann::Matrix<float>(points_.data(), points_.cols(), 3), flann::KDTreeSingleIndexParams(24)}}) {
  tree_->params.cores = 1;
  tree_->index.buildIndex();
}

FlannSearch::~FlannSearch() = default;

void FlannSearch::search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
                         std::vector<float>& sq_distances) const {
  const auto num_queries = static_cast<std::size_t>(queries.cols()), count = static_cast<std::size_t>(num_neighbors);
  indices.assign(num_queries * count, 0);
  sq_distances.assign(num_queries * count, kInfinity);
  constexpr Eigen::Index group_size = 12;  // queries
  const float margin = 1.0f + 3.0f / std::sqrt(static_cast<float>(num_neighbors));
  NearestOfGroup nearest_of_group(points_);
  float sq_expected = 0.0f;  // distance of the last neighbor, by the group before; 0: not known
  for (Eigen::Index begin = 0; begin < queries.cols(); begin += group_size) {
    const Eigen::Index end = std::min(queries.cols(), begin + group_size);
    const auto group = queries.middleCols(begin, end - begin);
    const Eigen::Vector3f low = group.rowwise().minCoeff(), high = group.rowwise().maxCoeff(),
                          center = 0.5f * (low + high);
    const float radius = 0.5f * (high - low).norm(), sq_limit = margin * sq_expected;
    const bool together = num_neighbors > 1 && radius * radius < 9.0f * sq_limit;
    if (together) {
      const float reach = 1.00001f * (radius + std::sqrt(sq_limit));  // rounding
      nearest_of_group.around.start(reach * reach);
      tree_->index.findNeighbors(nearest_of_group.around, center.data(), tree_->params);
    }
    sq_expected = 0.0f;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const float* const query = queries.col(static_cast<Eigen::Index>(i)).data();
      int* const found = &indices[i * count];
      float* const sq_found = &sq_distances[i * count];
      if (!together || !nearest_of_group.find(query, sq_limit, num_neighbors, found, sq_found)) {
        NearestPoints nearest(found, sq_found, num_neighbors);
        tree_->index.findNeighbors(nearest, query, tree_->params);
      }
      sq_expected += sq_found[num_neighbors - 1] / static_cast<float>(end - begin);
    }
  }
}

void FlannSearch::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                               std::vector<float>& sq_distances) const {
  const float limit = std::nextafter(max_sq_distance, kInfinity);  // FLANN finds points that are strictly closer
  std::vector<NeighborLists::Found> seen;
  if (lists_) seen = lists_->search(queries, indices);
  sq_distances.resize(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Eigen::Vector3f query = queries.col(static_cast<Eigen::Index>(i));
    const float guessed = indices[i] < 0 ? limit : (points_.col(indices[i]) - query).squaredNorm();
    ClosestPoint closest(guessed < limit ? indices[i] : -1, std::min(guessed, limit));
    const bool is_proven = lists_ && seen[i].is_closest;
    if (is_proven && seen[i].sq_distance < closest.worstDist()) {
      closest.addPoint(seen[i].sq_distance, static_cast<std::size_t>(seen[i].index));
    } else if (!is_proven) {
      // Just beyond what the lists found: of several points at that distance, FLANN chooses.
      const float beyond = lists_ ? std::nextafter(seen[i].sq_distance, kInfinity) : kInfinity;
      if (beyond < closest.worstDist()) closest = ClosestPoint(-1, beyond);
      tree_->index.findNeighbors(closest, query.data(), tree_->params);
    }
    indices[i] = closest.index();
    sq_distances[i] = indices[i] < 0 ? kInfinity : closest.worstDist();
  }
}

void ClosestPointSearch::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                                      std::vector<float>& sq_distances) const {
  search(queries, 1, indices, sq_distances);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (sq_distances[i] <= max_sq_distance) continue;
    indices[i] = -1;
    sq_distances[i] = kInfinity;
  }
}

ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points) {
  return std::make_shared<FlannSearch>(points);
}

}  // namespace pcl_symmetry
