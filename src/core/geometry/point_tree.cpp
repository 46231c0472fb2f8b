#include "core/geometry/point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/point_samples.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace pcl_symmetry {

namespace {

constexpr int kMostInLeaf = 10;  // points. derived: FLANN's default, which decides between points equally far away
// Queries whose neighbours are looked for together, and those before the first that are asked alone. measured: nine
// nearest of 10 000 points take 1.4 ms, with half as many together 1.5; twice as many take as long.
constexpr Eigen::Index kSideBySide = 64, kFirstAlone = 8;
// Deviations of the number of points within a distance by which it shall exceed the neighbours that are wanted.
// measured: half takes as long, as more queries are asked again alone; twice takes 1.7 ms, and with 17 neighbours twice
// the time.
constexpr double kMarginOfCount = 3.0;
constexpr int kLanes = 4;  // derived: floats in a register of every x86-64 processor

/// The closest points so far, nearest first.
class ClosestPoints {
public:
  ClosestPoints(int* indices, float* sq_distances, int most)
      : indices_(indices), sq_distances_(sq_distances), most_(most) {}

  float worst() const { return worst_; }
  void offer(float sq_distance, int index) {
    if (!(sq_distance < worst_)) return;
    if (size_ < most_) ++size_;
    int i = size_ - 1;
    for (; i > 0 && sq_distances_[i - 1] > sq_distance; --i) {
      sq_distances_[i] = sq_distances_[i - 1];
      indices_[i] = indices_[i - 1];
    }
    sq_distances_[i] = sq_distance;
    indices_[i] = index;
    if (size_ == most_) worst_ = sq_distances_[most_ - 1];
  }

private:
  int* indices_;
  float* sq_distances_;
  int most_, size_ = 0;
  float worst_ = std::numeric_limits<float>::max();
};

/// The one closest point so far.
class ClosestPoint {
public:
  ClosestPoint(int index, float sq_distance) : index_(index), worst_(sq_distance) {}

  int index() const { return index_; }
  float worst() const { return worst_; }
  void offer(float sq_distance, int index) {
    if (!(sq_distance < worst_)) return;
    worst_ = sq_distance;
    index_ = index;
  }

private:
  int index_;
  float worst_;
};

/// Where a box of points is divided: the middle of the points along the axis on which they spread most.
struct Division {
  int axis;
  float at;
};

Division divisionOf(const Eigen::Array3f& box_span, const Eigen::Array3f& low, const Eigen::Array3f& high) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (box_span[i] > box_span[axis]) axis = i;
  const int first = axis;
  for (int i = 0; i < 3; ++i)
    if (i != first && box_span[i] > high[axis] - low[axis] && high[i] - low[i] > high[axis] - low[axis]) axis = i;
  return {axis, (low[axis] + high[axis]) / 2.0f};
}

std::array<float, 4> corner(const Eigen::Array3f& of_box) {
  return {of_box[0], of_box[1], of_box[2], 0.0f};
}

/// Moves entries that satisfy a condition to the front, by exchanging the outermost pairs that stand wrongly. All of
/// these are listed first, without a branch that half of the entries would take.
/// \param places storage for as many as there are entries.
/// \return index of the first that does not.
template <typename Entry, typename Condition>
int moveToFront(std::vector<Entry>& entries, int begin, int end, const Condition& condition, std::vector<int>& places) {
  int middle = begin;
  for (int i = begin; i < end; ++i) middle += condition(entries[i]) ? 1 : 0;
  int* const left = places.data();
  int num_left = 0;
  for (int i = begin; i < middle; ++i) {
    left[num_left] = i;
    num_left += condition(entries[i]) ? 0 : 1;
  }
  int* const right = left + num_left;
  int num_right = 0;
  for (int i = end - 1; num_right < num_left; --i) {
    right[num_right] = i;
    num_right += condition(entries[i]) ? 1 : 0;
  }
  for (int k = 0; k < num_left; ++k) std::swap(entries[left[k]], entries[right[k]]);
  return middle;
}

}  // namespace

PointTree::PointTree(const PointsRef& points) : points_(points) {
  const auto size = static_cast<std::size_t>(points.cols());
  std::vector<Entry> entries(size);
  for (std::size_t i = 0; i < size; ++i) entries[i] = {points_.col(static_cast<Eigen::Index>(i)), static_cast<int>(i)};
  nodes_.reserve(size / 2 + 1);
  std::vector<int> places(size + 1);
  divide(entries, places, 0, static_cast<int>(size),
         {points_.rowwise().minCoeff().array(), points_.rowwise().maxCoeff().array()}, 1);
  for (auto* coordinates : {&ordered_.x, &ordered_.y, &ordered_.z})
    coordinates->assign(size + WideTree::kChildren, 0.0f);
  index_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    ordered_.x[i] = entries[i].point.x();
    ordered_.y[i] = entries[i].point.y();
    ordered_.z[i] = entries[i].point.z();
    index_[i] = entries[i].index;
  }
  if (WideTree::isSupported()) wide_.emplace(nodes_);
}

/// Adds the node of some points and those below it.
/// \param places storage for as many as there are points, and one more.
/// \param box contains the points.
/// \return the bounding box of the points.
PointTree::Box PointTree::divide(std::vector<Entry>& entries, std::vector<int>& places, int begin, int end, Box box,
                                 int depth) {
  depth_ = std::max(depth_, depth);
  Box bounds{entries[begin].point.array(), entries[begin].point.array()};
  for (int i = begin + 1; i < end; ++i) {
    bounds.low = bounds.low.min(entries[i].point.array());
    bounds.high = bounds.high.max(entries[i].point.array());
  }
  const std::size_t node = nodes_.size();
  const int count = end - begin;
  nodes_.push_back({corner(bounds.low), corner(bounds.high), begin, 0, count <= kMostInLeaf ? count : 0});
  if (count <= kMostInLeaf) return bounds;
  const auto [axis, at] = divisionOf(box.high - box.low, bounds.low, bounds.high);
  const auto coordinate = [axis = axis](const Entry& entry) { return entry.point[axis]; };
  // Points at the division itself go to either side, so that both are as large as possible.
  const int below = moveToFront(
      entries, begin, end, [&, at = at](const Entry& e) { return coordinate(e) < at; }, places);
  const int up_to = moveToFront(
      entries, below, end, [&, at = at](const Entry& e) { return coordinate(e) <= at; }, places);
  const int middle = std::clamp(begin + count / 2, below, up_to);
  Box first = box, second = box;
  first.high[axis] = second.low[axis] = at;
  first = divide(entries, places, begin, middle, first, depth + 1);
  const auto link = static_cast<std::int32_t>(nodes_.size());
  second = divide(entries, places, middle, end, second, depth + 1);
  nodes_[node].low[3] = first.high[axis];
  nodes_[node].high[3] = second.low[axis];
  nodes_[node].link = link;
  nodes_[node].axis = axis;
  return bounds;
}

template <typename Result>
void PointTree::visitLeaf(const Node& leaf, const Eigen::Vector3f& query, Result& result) const {
#if defined(__SSE2__)
  const __m128 x = _mm_set1_ps(query.x()), y = _mm_set1_ps(query.y()), z = _mm_set1_ps(query.z());
  for (int k = 0; k < leaf.num_points; k += kLanes) {
    const int first = leaf.link + k;
    const __m128 dx = _mm_sub_ps(x, _mm_loadu_ps(&ordered_.x[first])),
                 dy = _mm_sub_ps(y, _mm_loadu_ps(&ordered_.y[first])),
                 dz = _mm_sub_ps(z, _mm_loadu_ps(&ordered_.z[first]));
    const __m128 sq = _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    int near = _mm_movemask_ps(_mm_cmplt_ps(sq, _mm_set1_ps(result.worst())));
    near &= (1 << std::min(kLanes, leaf.num_points - k)) - 1;
    if (near == 0) continue;
    alignas(16) float sq_distances[kLanes];
    _mm_store_ps(sq_distances, sq);
    for (int lane = 0; near >> lane; ++lane)
      if (near >> lane & 1) result.offer(sq_distances[lane], index_[first + lane]);
  }
#else
  for (int i = leaf.link; i < leaf.link + leaf.num_points; ++i) {
    const float dx = query.x() - ordered_.x[i], dy = query.y() - ordered_.y[i], dz = query.z() - ordered_.z[i];
    result.offer(dx * dx + dy * dy + dz * dz, index_[i]);
  }
#endif
}

/// Squared distance of a point from the box of a node: rounded, it is at most that of each point in the box.
[[gnu::always_inline]] inline float PointTree::sqDistance(const Node& node, const Eigen::Vector3f& query) {
#if defined(__SSE2__)
  const __m128 x = _mm_setr_ps(query.x(), query.y(), query.z(), 0.0f);
  const __m128 below = _mm_sub_ps(_mm_loadu_ps(node.low.data()), x);
  const __m128 above = _mm_sub_ps(x, _mm_loadu_ps(node.high.data()));
  const __m128 gap = _mm_max_ps(_mm_max_ps(below, above), _mm_setzero_ps());
  const __m128 sq = _mm_mul_ps(gap, gap);
  return _mm_cvtss_f32(_mm_add_ss(_mm_add_ss(sq, _mm_shuffle_ps(sq, sq, 1)), _mm_movehl_ps(sq, sq)));
#else
  float sum = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float gap = std::max(std::max(node.low[axis] - query[axis], query[axis] - node.high[axis]), 0.0f);
    sum += gap * gap;
  }
  return sum;
#endif
}

/// Shows the result the leaves that may hold closer points than it has, the nearer child of each node first.
/// \param pending storage.
template <typename Result>
void PointTree::visit(const Eigen::Vector3f& query, std::vector<Pending>& pending, Result& result) const {
  std::size_t num_pending = 0;
  std::int32_t at = 0;
  while (true) {
    const Node* node = &nodes_[at];
    while (node->num_points == 0) {
      const float value = query[node->axis];
      const bool first = (value - node->low[3]) + (value - node->high[3]) < 0.0f;
      const std::int32_t near = first ? at + 1 : node->link, other = first ? node->link : at + 1;
      pending[num_pending] = {other, sqDistance(nodes_[other], query)};
      num_pending += pending[num_pending].sq_distance < result.worst() ? 1 : 0;
      at = near;
      node = &nodes_[at];
    }
    visitLeaf(*node, query, result);
    do {
      if (num_pending == 0) return;
      --num_pending;
    } while (!(pending[num_pending].sq_distance < result.worst()));
    at = pending[num_pending].node;
  }
}

/// \param start a point, which is the answer unless another one is strictly closer; or -1 and a limit.
PointTree::Match PointTree::closest(const Eigen::Vector3f& query, Match start, Storage& storage) const {
  WideTree::Closest found{start.sq_distance};
  if (wide_) wide_->findClosest(ordered_, query.data(), storage.wide, found);
  return closest(query, start, found, storage);
}

/// \param found by the tree with eight children, if there is one.
PointTree::Match PointTree::closest(const Eigen::Vector3f& query, Match start, const WideTree::Closest& found,
                                    Storage& storage) const {
  if (wide_ && found.place < 0) return start;
  if (wide_ && !found.is_tied) return {index_[static_cast<std::size_t>(found.place)], found.sq_distance};
  // Of several points equally far away, the one that the tree with two children comes to first.
  ClosestPoint result(start.index, start.sq_distance);
  visit(query, storage.pending, result);
  return {result.index(), result.worst()};
}

/// closest() for at most NeighbourLists::kTogether queries: by walks along the lists, and by the tree for all of which
/// these do not decide.
/// \param guesses a point each that is likely to be close, or -1.
/// \param[in,out] matches where to start; the answers.
void PointTree::closestByWalks(const PointsRef& queries, const int* guesses, std::vector<Match>& matches,
                               Storage& storage) const {
  std::array<int, NeighbourLists::kTogether> seen;
  std::array<float, NeighbourLists::kTogether> sq_seen;
  std::array<char, NeighbourLists::kTogether> is_closest;
  for (std::size_t i = 0; i < matches.size(); ++i)
    seen[i] = guesses[i] >= 0 ? guesses[i] : lists_->start(queries.col(static_cast<Eigen::Index>(i)));
  lists_->walk(queries, seen.data(), sq_seen.data(), is_closest.data());
  std::vector<int>& open = storage.open;
  std::vector<WideTree::Closest>& found = storage.found;
  open.clear();
  found.clear();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    Match& match = matches[i];
    if (is_closest[i] != 0) {
      if (sq_seen[i] < match.sq_distance) match = {seen[i], sq_seen[i]};
      continue;
    }
    // A limit just beyond the point that was seen: the tree decides which one it finds of several at that distance.
    const float limit = std::nextafter(sq_seen[i], std::numeric_limits<float>::infinity());
    if (limit < match.sq_distance) match = {-1, limit};
    open.push_back(static_cast<int>(i));
    found.push_back({match.sq_distance});
  }
  const Points asked = pointsAt(queries, open);
  wide_->findClosestOfMany(ordered_, asked, found, storage.many);
  for (std::size_t k = 0; k < open.size(); ++k) {
    Match& match = matches[static_cast<std::size_t>(open[k])];
    match = closest(asked.col(static_cast<Eigen::Index>(k)), match, found[k], storage);
  }
}

PointTree::Storage PointTree::storage() const {
  Storage storage;
  storage.pending.resize(static_cast<std::size_t>(depth_));
  if (wide_) storage.wide = wide_->pending();
  return storage;
}

void PointTree::search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
                       std::vector<float>& sq_distances) const {
  const auto num_queries = static_cast<std::size_t>(queries.cols());
  indices.resize(num_queries * num_neighbours);
  sq_distances.resize(num_queries * num_neighbours);
  Storage storage = this->storage();
  if (num_neighbours > 1 && num_neighbours <= WideTree::kMostOfMany && wide_)
    return nearestOfMany(queries, num_neighbours, indices.data(), sq_distances.data(), storage);
  for (std::size_t i = 0; i < num_queries; ++i) {
    const Eigen::Vector3f query = queries.col(static_cast<Eigen::Index>(i));
    if (num_neighbours > 1) {
      nearest(query, num_neighbours, &indices[i * num_neighbours], &sq_distances[i * num_neighbours], storage);
      continue;
    }
    const Match match = closest(query, {0, std::numeric_limits<float>::max()}, storage);
    indices[i] = match.index;
    sq_distances[i] = match.sq_distance;
  }
}

/// \param[out] indices,sq_distances of the closest points to a query.
void PointTree::nearest(const Eigen::Vector3f& query, int num_neighbours, int* indices, float* sq_distances,
                        Storage& storage) const {
  if (wide_ && !wide_->findNearest(ordered_, query.data(), num_neighbours, storage.wide, indices, sq_distances)) {
    for (int k = 0; k < num_neighbours; ++k) indices[k] = index_[static_cast<std::size_t>(indices[k])];
    return;
  }
  ClosestPoints found(indices, sq_distances, num_neighbours);
  visit(query, storage.pending, found);
}

/// The same for many queries: the points around some say within which distance those of the next ones are likely to be.
void PointTree::nearestOfMany(const PointsRef& queries, int num_neighbours, int* indices, float* sq_distances,
                              Storage& storage) const {
  const double margin = 1.0 + kMarginOfCount / std::sqrt(num_neighbours);
  double sum = 0.0;  // of the squared distances of the last neighbours of the queries before
  Eigen::Index num_before = 0;
  for (Eigen::Index begin = 0; begin < queries.cols();) {
    const Eigen::Index most = num_before > 0 ? kSideBySide : kFirstAlone;
    const Points some = queries.middleCols(begin, std::min(most, queries.cols() - begin));
    const auto size = static_cast<std::size_t>(some.cols());
    int* const found = indices + begin * num_neighbours;
    float* const sq_found = sq_distances + begin * num_neighbours;
    std::vector<char> is_open(size, 1);
    if (num_before > 0) {
      const auto sq_limit = static_cast<float>(margin * sum / static_cast<double>(num_before));
      is_open = wide_->findNearestOfMany(ordered_, some, std::vector<WideTree::Closest>(size, {sq_limit}),
                                         num_neighbours, found, sq_found, storage.many);
    }
    sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      int* const own = found + i * static_cast<std::size_t>(num_neighbours);
      float* const sq_own = sq_found + i * static_cast<std::size_t>(num_neighbours);
      if (is_open[i])
        nearest(some.col(static_cast<Eigen::Index>(i)), num_neighbours, own, sq_own, storage);
      else
        for (int k = 0; k < num_neighbours; ++k) own[k] = index_[static_cast<std::size_t>(own[k])];
      sum += sq_own[num_neighbours - 1];
    }
    num_before = some.cols();
    begin += some.cols();
  }
}

void PointTree::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                             std::vector<float>& sq_distances) const {
  // Points strictly closer than the limit are accepted.
  const float limit = std::nextafter(max_sq_distance, std::numeric_limits<float>::infinity());
  const auto size = static_cast<Eigen::Index>(indices.size());
  sq_distances.resize(indices.size());
  Storage storage = this->storage();
  std::vector<Match> matches;
  for (Eigen::Index begin = 0; begin < size; begin += NeighbourLists::kTogether) {
    const PointsRef some = queries.middleCols(begin, std::min<Eigen::Index>(NeighbourLists::kTogether, size - begin));
    int* const guesses = indices.data() + begin;
    matches.assign(static_cast<std::size_t>(some.cols()), {-1, limit});
    for (Eigen::Index i = 0; i < some.cols(); ++i) {
      if (guesses[i] < 0) continue;
      const float guessed = (points_.col(guesses[i]) - some.col(i)).squaredNorm();
      if (guessed < limit) matches[static_cast<std::size_t>(i)] = {guesses[i], guessed};
    }
    if (lists_) closestByWalks(some, guesses, matches, storage);
    for (Eigen::Index i = 0; i < some.cols(); ++i) {
      Match match = matches[static_cast<std::size_t>(i)];
      if (!lists_) match = closest(some.col(i), match, storage);
      guesses[i] = match.index;
      sq_distances[static_cast<std::size_t>(begin + i)] =
          match.index < 0 ? std::numeric_limits<float>::infinity() : match.sq_distance;
    }
  }
}

ClosestPointSearch::Ptr makeTreeSearch(const PointsRef& points) {
  return std::make_shared<PointTree>(points);
}

}  // namespace pcl_symmetry
