#include "core/geometry/closest_points.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// FLANN visits all points that may be as close as its worst result. Equal points, such as those at the origin for
// pixels without a depth, would then cost the square of their number. The search therefore ends at a distance of 0.
float visitedUpTo(float worst_sq_distance) {
  return worst_sq_distance > 0.0f ? worst_sq_distance : -1.0f;
}

/// Keeps the closest of the points that FLANN passes to it.
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

/// Keeps several of the closest points that FLANN passes to it, nearest first.
class NearestPoints : public flann::ResultSet<float> {
public:
  NearestPoints(int* indices, float* sq_distances, int max_count)
      : indices_(indices), sq_distances_(sq_distances), max_count_(max_count) {}

  bool full() const override { return size_ == max_count_; }
  void addPoint(float sq_distance, std::size_t index) override {
    if (sq_distance >= worst_) return;
    if (size_ < max_count_) ++size_;
    int i = size_ - 1;
    for (; i > 0 && sq_distances_[i - 1] > sq_distance; --i) {
      sq_distances_[i] = sq_distances_[i - 1];
      indices_[i] = indices_[i - 1];
    }
    sq_distances_[i] = sq_distance;
    indices_[i] = static_cast<int>(index);
    if (size_ == max_count_) worst_ = sq_distances_[max_count_ - 1];
  }
  float worstDist() const override { return visitedUpTo(worst_); }

private:
  int* indices_;
  float* sq_distances_;
  int max_count_, size_ = 0;
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

}  // namespace

/// A distance transform with the index of the closest point: sweeps from four corners pass points on to all cells.
ClosestPointGrid::ClosestPointGrid(const PointsRef& points, int num_cells) : n_(num_cells) {
  check(points.cols() >= 1, "number of points", points.cols(), ">= 1");
  check(n_ >= 2, "num_cells", n_, ">= 2");
  const BoundingBall ball = boundingBall(points);
  const double half = ball.radius > 0.0 ? 1.25 * ball.radius : 1.0;
  cell_size_ = static_cast<float>(2.0 * half / n_);
  last_ = static_cast<float>(n_) - 0.5f;
  origin_ = (ball.center.array() - half).matrix().cast<float>();
  nearest_.assign(static_cast<std::size_t>(n_) * n_ * n_, -1);
  std::vector<float> sq_distances(nearest_.size(), std::numeric_limits<float>::infinity());

  // The cell keeps the point if it is closer to the center than the current one.
  const auto offer = [&](int point, int x, int y, int z) {
    int& nearest = nearest_[indexOf(x, y, z)];
    if (point < 0 || point == nearest) return;
    const Eigen::Vector3f center = origin_ + cell_size_ * Eigen::Vector3f(x + 0.5f, y + 0.5f, z + 0.5f);
    const float sq_distance = (points.col(point) - center).squaredNorm();
    float& least = sq_distances[indexOf(x, y, z)];
    if (!(sq_distance < least)) return;
    least = sq_distance;
    nearest = point;
  };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i cell = cellOf(points.col(i));
    offer(static_cast<int>(i), cell.x(), cell.y(), cell.z());
  }
  for (const int corner : {0, 3, 5, 6}) {
    const int dx = corner & 1 ? -1 : 1, dy = corner & 2 ? -1 : 1, dz = corner & 4 ? -1 : 1;
    for (int k = 0, z = dz > 0 ? 0 : n_ - 1; k < n_; ++k, z += dz)
      for (int j = 0, y = dy > 0 ? 0 : n_ - 1; j < n_; ++j, y += dy)
        for (int i = 0, x = dx > 0 ? 0 : n_ - 1; i < n_; ++i, x += dx) {
          if (i > 0) offer(nearest_[indexOf(x - dx, y, z)], x, y, z);
          if (j > 0) offer(nearest_[indexOf(x, y - dy, z)], x, y, z);
          if (k > 0) offer(nearest_[indexOf(x, y, z - dz)], x, y, z);
        }
  }
}

bool NeighborLists::isUseful(Eigen::Index num_points) {
#if defined(__x86_64__)
  static const bool is_supported = __builtin_cpu_supports("avx2");
  return num_points > kNeighbors && num_points <= 50'000 && is_supported;
#else
  return false;
#endif
}

NeighborLists::NeighborLists(const Points& points, const std::vector<int>& nearest, const std::vector<float>& sq_reach)
    : lists_(sq_reach.size()), grid_(points, 32) {
  for (int i = 0; i < static_cast<int>(lists_.size()); ++i) {
    List& list = lists_[i];
    list.own_x = points(0, i);
    list.own_y = points(1, i);
    list.own_z = points(2, i);
    // (1 / 2)^2, less the rounding of distances
    list.max_sq_distance = 0.2499f * sq_reach[i];
    // The point itself is among the nearest, unless as many others are at the same position.
    for (int k = 0, count = 0; k <= kNeighbors && count < kNeighbors; ++k) {
      const int j = nearest[static_cast<std::size_t>(i) * (kNeighbors + 1) + static_cast<std::size_t>(k)];
      if (j == i) continue;
      list.x[count] = points(0, j);
      list.y[count] = points(1, j);
      list.z[count] = points(2, j);
      list.index[count++] = static_cast<std::uint16_t>(j);
    }
  }
}

#if defined(__x86_64__)

__attribute__((target("avx2"))) std::vector<NeighborLists::Found> NeighborLists::search(
    const PointsRef& queries, const std::vector<int>& guesses) const {
  constexpr std::size_t together = 256;  // queries per round: they stay in the first-level cache
  std::vector<Found> found(guesses.size());
  std::array<std::size_t, together> walking;
  for (std::size_t begin = 0; begin < found.size(); begin += together) {
    std::size_t num_walking = 0;
    for (std::size_t i = begin; i < std::min(begin + together, found.size()); ++i) {
      const Eigen::Vector3f query = queries.col(i);
      found[i].index = guesses[i] >= 0 ? guesses[i] : grid_.closest(query);
      const List& list = lists_[found[i].index];
      const float dx = query.x() - list.own_x, dy = query.y() - list.own_y, dz = query.z() - list.own_z;
      found[i].sq_distance = dx * dx + dy * dy + dz * dz;
      walking[num_walking++] = i;
    }
    while (num_walking > 0) {
      std::size_t num_on = 0;
      for (std::size_t w = 0; w < num_walking; ++w) {
        const std::size_t i = walking[w];
        Found& at = found[i];
        const List& list = lists_[at.index];
        const float* const query = queries.data() + queries.outerStride() * static_cast<Eigen::Index>(i);
        const __m256 ax = _mm256_sub_ps(_mm256_broadcast_ss(query), _mm256_load_ps(list.x)),
                     ay = _mm256_sub_ps(_mm256_broadcast_ss(query + 1), _mm256_load_ps(list.y)),
                     az = _mm256_sub_ps(_mm256_broadcast_ss(query + 2), _mm256_load_ps(list.z));
        const __m256 sq =
            _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ax, ax), _mm256_mul_ps(ay, ay)), _mm256_mul_ps(az, az));
        __m128 least = _mm_min_ps(_mm256_castps256_ps128(sq), _mm256_extractf128_ps(sq, 1));
        least = _mm_min_ps(least, _mm_movehl_ps(least, least));
        least = _mm_min_ss(least, _mm_movehdup_ps(least));
        const auto lanes =
            static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_broadcastss_ps(least), _CMP_EQ_OQ)));
        const float sq_least = _mm_cvtss_f32(least), sq_before = at.sq_distance;
        const bool decides = sq_before <= list.max_sq_distance;
        const bool is_closer = sq_least < sq_before, is_alone = (lanes & (lanes - 1)) == 0;
        constexpr unsigned last = 1u << (kNeighbors - 1);  // if distances are NaN, no lane is set
        const int change = list.index[__builtin_ctz(lanes | last)] - at.index;
        at.index += change & -static_cast<int>(is_closer);  // no branch: half of the guesses are the closest points
        at.sq_distance = _mm_cvtss_f32(_mm_min_ss(least, _mm_set_ss(sq_before)));
        at.is_closest = decides & ((is_closer & is_alone) | (sq_least > sq_before));
        __builtin_prefetch(lists_[at.index].x);  // for the next round
        __builtin_prefetch(lists_[at.index].z);
        walking[num_on] = i;
        num_on += is_closer & is_alone & !decides;
      }
      num_walking = num_on;
    }
  }
  return found;
}

#else

std::vector<NeighborLists::Found> NeighborLists::search(const PointsRef&, const std::vector<int>&) const {
  return {};  // there are no lists, see isUseful()
}

#endif

void NeighborWalk::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                                std::vector<float>& sq_distances) const {
  const std::vector<NeighborLists::Found> found = lists_.search(queries, indices);
  sq_distances.resize(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const bool is_within = found[i].sq_distance <= max_sq_distance;
    indices[i] = is_within ? found[i].index : -1;
    sq_distances[i] = is_within ? found[i].sq_distance : std::numeric_limits<float>::infinity();
  }
}

struct FlannSearch::Tree {
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index;
  flann::SearchParams params{flann::FLANN_CHECKS_UNLIMITED, 0.0f, true};
};

FlannSearch::FlannSearch(const PointsRef& points)
    : points_(points),
      tree_(new Tree{{flann::Matrix<float>(points_.data(), points_.cols(), 3), flann::KDTreeSingleIndexParams(24)}}) {
  tree_->params.cores = 1;
  tree_->index.buildIndex();
  checkCancelled();
}

FlannSearch::~FlannSearch() = default;

void FlannSearch::search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
                         std::vector<float>& sq_distances) const {
  const auto num_queries = static_cast<std::size_t>(queries.cols()), count = static_cast<std::size_t>(num_neighbors);
  indices.assign(num_queries * count, 0);
  sq_distances.assign(num_queries * count, kInfinity);
  flann::SearchParams params = tree_->params;
  params.eps = 4.0f * std::numeric_limits<float>::epsilon();  // ignores points that are closer by rounding only
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
      // Just beyond the result of the lists: of several points at that distance, FLANN chooses one.
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

ClosestPoints closestPoints(const ClosestPointSearch& search, const PointsRef& queries, int num_threads) {
  const std::size_t size = queries.cols();
  ClosestPoints found{std::vector<int>(size), std::vector<float>(size)};
  parallelPoints(size, num_threads, [&](std::size_t begin, std::size_t end) {
    ClosestPoints part;
    search.search(queries.middleCols(begin, end - begin), 1, part.index, part.sq_distances);
    std::copy(part.index.begin(), part.index.end(), found.index.begin() + begin);
    std::copy(part.sq_distances.begin(), part.sq_distances.end(), found.sq_distances.begin() + begin);
  });
  return found;
}

ClosestPointSearch::Ptr makeFlannSearch(const PointsRef& points) {
  return std::make_shared<FlannSearch>(points);
}

ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale) {
  return std::make_shared<SearchInFrame>(std::move(search), center, scale);
}

}  // namespace pcl_symmetry
