#include "core/geometry/closest_points.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// FLANN visits all that may be as close as the worst of what it has. Equal points, as those at the origin for pixels
// without a depth, would then cost the square of their number. Nothing is closer than 0, there it ends.
float visitedUpTo(float worst_sq_distance) {
  return worst_sq_distance > 0.0f ? worst_sq_distance : -1.0f;
}

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
  float worstDist() const override { return visitedUpTo(sq_distance_); }

  int index() const { return index_; }
  float sqDistance() const { return sq_distance_; }

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
  float worstDist() const override { return visitedUpTo(worst_); }

private:
  int* indices_;
  float* sq_distances_;
  int most_, size_ = 0;
  float worst_ = std::numeric_limits<float>::max();
};

class SearchInFrame : public ClosestPointSearch {
public:
  SearchInFrame(Ptr search, const Eigen::Vector3d& center, double scale)
      : search_(std::move(search)), center_(center), scale_(scale) {}

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    const Points moved = ((queries.cast<double>() * scale_).colwise() + center_).cast<float>();
    search_->search(moved, num_neighbors, indices, sq_distances);
    for (float& sq_distance : sq_distances) sq_distance = static_cast<float>(sq_distance / (scale_ * scale_));
  }

private:
  Ptr search_;
  Eigen::Vector3d center_;
  double scale_;
};

class SearchAmong : public ClosestPointSearch {
public:
  SearchAmong(Ptr search, std::size_t num_points, const std::vector<int>& kept)
      : search_(std::move(search)), num_kept_(kept.size()), index_of_(num_points, -1) {
    for (std::size_t i = 0; i < kept.size(); ++i) index_of_[kept[i]] = static_cast<int>(i);
  }

  /// Asks for more neighbors until enough of them are kept.
  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    const auto wanted = static_cast<std::size_t>(num_neighbors);
    check(wanted <= num_kept_, "num_neighbors", num_neighbors, "at most the number of points");
    indices.clear();
    sq_distances.clear();
    std::vector<int> found;
    std::vector<float> sq_found;
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
      const std::size_t end = static_cast<std::size_t>(i + 1) * wanted;
      for (std::size_t count = 2 * wanted; indices.size() < end; count *= 2) {
        count = std::min(count, index_of_.size());
        search_->search(queries.col(i), static_cast<int>(count), found, sq_found);
        indices.resize(end - wanted);
        sq_distances.resize(end - wanted);
        for (std::size_t k = 0; k < count && indices.size() < end; ++k) {
          const int index = index_of_[found[k]];
          if (index < 0) continue;
          indices.push_back(index);
          sq_distances.push_back(sq_found[k]);
        }
      }
    }
  }

private:
  Ptr search_;
  std::size_t num_kept_;
  std::vector<int> index_of_;  ///< among those kept, of each point; -1: not kept
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
  flann::SearchParams params = tree_->params;
  params.eps = 4.0f * std::numeric_limits<float>::epsilon();  // leaves out what is no closer but for rounding
  for (std::size_t i = 0; i < num_queries; ++i) {
    NearestPoints nearest(&indices[i * count], &sq_distances[i * count], num_neighbors);
    tree_->index.findNeighbors(nearest, queries.col(i).data(), params);
  }
}

void FlannSearch::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                               std::vector<float>& sq_distances) const {
  const float limit = std::nextafter(max_sq_distance, kInfinity);  // FLANN finds points that are strictly closer
  std::vector<NeighborLists::Found> seen;
  if (lists_) seen = lists_->search(queries, indices);
  sq_distances.resize(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Eigen::Vector3f query = queries.col(i);
    const float guessed = indices[i] < 0 ? limit : (points_.col(indices[i]) - query).squaredNorm();
    ClosestPoint closest(guessed < limit ? indices[i] : -1, std::min(guessed, limit));
    const bool is_proven = lists_ && seen[i].is_closest;
    if (is_proven && seen[i].sq_distance < closest.sqDistance()) {
      closest.addPoint(seen[i].sq_distance, static_cast<std::size_t>(seen[i].index));
    } else if (!is_proven) {
      // Just beyond what the lists found: of several points at that distance, FLANN chooses.
      const float beyond = lists_ ? std::nextafter(seen[i].sq_distance, kInfinity) : kInfinity;
      if (beyond < closest.sqDistance()) closest = ClosestPoint(-1, beyond);
      tree_->index.findNeighbors(closest, query.data(), tree_->params);
    }
    indices[i] = closest.index();
    sq_distances[i] = indices[i] < 0 ? kInfinity : closest.sqDistance();
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

ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale) {
  return std::make_shared<SearchInFrame>(std::move(search), center, scale);
}

ClosestPointSearch::Ptr among(ClosestPointSearch::Ptr search, std::size_t num_points, const std::vector<int>& kept) {
  return std::make_shared<SearchAmong>(std::move(search), num_points, kept);
}

}  // namespace pcl_symmetry
