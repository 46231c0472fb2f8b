#include "core/geometry/wide_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

// Points. chosen: two vectors; at half, a query visits more nodes, at twice, it looks at points that are far away.
constexpr int kMostInWideLeaf = 16;

/// Several of the closest points, nearest first.
class NearestPlaces {
public:
  NearestPlaces(std::int32_t* places, float* sq_distances, int most)
      : places_(places), sq_distances_(sq_distances), most_(most) {}

  float worst() const { return worst_; }
  bool isTied() const { return is_tied_; }
  bool isFull() const { return size_ == most_; }
  /// \pre sq_distance <= worst()
  void offer(float sq_distance, std::int32_t place) {
    if (size_ == most_ && sq_distance == worst_) {
      is_tied_ = true;
      return;
    }
    if (size_ < most_) ++size_;
    int i = size_ - 1;
    for (; i > 0 && sq_distances_[i - 1] > sq_distance; --i) {
      sq_distances_[i] = sq_distances_[i - 1];
      places_[i] = places_[i - 1];
    }
    is_tied_ |= i > 0 && sq_distances_[i - 1] == sq_distance;
    sq_distances_[i] = sq_distance;
    places_[i] = place;
    if (size_ == most_) worst_ = sq_distances_[most_ - 1];
  }

private:
  std::int32_t* places_;
  float* sq_distances_;
  int most_, size_ = 0;
  float worst_ = std::numeric_limits<float>::max();
  bool is_tied_ = false;
};

/// The closest point.
class ClosestPlace {
public:
  explicit ClosestPlace(WideTree::Closest& closest) : closest_(closest) {}

  float worst() const { return closest_.sq_distance; }
  /// \pre sq_distance <= worst()
  void offer(float sq_distance, std::int32_t place) {
    closest_.is_tied = sq_distance == closest_.sq_distance;
    if (closest_.is_tied) return;
    closest_.sq_distance = sq_distance;
    closest_.place = place;
  }

private:
  WideTree::Closest& closest_;
};

/// For each set of lanes of a vector, an order of the lanes in which these come first.
struct LanesFirst {
  std::array<std::array<std::uint8_t, WideTree::kChildren>, 1u << WideTree::kChildren> of{};

  constexpr LanesFirst() {
    for (unsigned lanes = 0; lanes < of.size(); ++lanes)
      for (unsigned lane = 0, next = 0; lane < WideTree::kChildren; ++lane)
        if (lanes >> lane & 1u) of[lanes][next++] = static_cast<std::uint8_t>(lane);
  }
};
constexpr LanesFirst kLanesFirst;

}  // namespace

void WideTree::Pairs::makeRoom(std::size_t num_more) {
  // Whole vectors are written, whose last lanes count for nothing.
  const std::size_t most = size + num_more + kChildren;
  if (queries.size() >= most) return;
  queries.resize(most);
  children.resize(most);
}

bool WideTree::isSupported() {
#if defined(__x86_64__)
  static const bool is_supported = __builtin_cpu_supports("avx2");
  return is_supported;
#else
  return false;
#endif
}

WideTree::WideTree(const std::vector<PointTreeNode>& nodes) {
  // The points of a node are those of its children, which follow it.
  std::vector<Leaf> ranges(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const PointTreeNode& node = nodes[i];
    if (node.num_points > 0) {
      ranges[i] = {node.link, node.num_points};
    } else {
      const Leaf &first = ranges[i + 1], &second = ranges[static_cast<std::size_t>(node.link)];
      ranges[i] = {first.first, first.num_points + second.num_points};
    }
  }
  add(nodes, ranges, 0, 1);
}

/// Adds a node of the tree with two children, and those below it.
std::int32_t WideTree::add(const std::vector<PointTreeNode>& nodes, const std::vector<Leaf>& ranges, std::int32_t node,
                           std::size_t level) {
  num_pending_ = std::max(num_pending_, level * kChildren);
  std::array<std::int32_t, kChildren> parts{node};
  int num_parts = 1;
  // Divides the part with the most points, until there are as many as a node has children.
  while (num_parts < kChildren) {
    int largest = 0;
    for (int k = 1; k < num_parts; ++k)
      if (ranges[parts[k]].num_points > ranges[parts[largest]].num_points) largest = k;
    const std::int32_t part = parts[largest];
    if (nodes[part].num_points > 0 || (ranges[part].num_points <= kMostInWideLeaf && part != node)) break;
    parts[largest] = part + 1;
    parts[num_parts++] = nodes[part].link;
  }
  const auto at = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  for (int k = 0; k < kChildren; ++k) {
    constexpr float kNowhere = std::numeric_limits<float>::max();  // derived: its square is infinite
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[at].low[axis][k] = k < num_parts ? nodes[parts[k]].low[axis] : kNowhere;
      nodes_[at].high[axis][k] = k < num_parts ? nodes[parts[k]].high[axis] : kNowhere;
    }
    std::int32_t child = -1;
    if (k < num_parts && ranges[parts[k]].num_points <= kMostInWideLeaf) {
      leaves_.push_back(ranges[parts[k]]);
      child = -static_cast<std::int32_t>(leaves_.size());
    } else if (k < num_parts) {
      child = add(nodes, ranges, parts[k], level + 1);
    }
    nodes_[at].children[k] = child;
  }
  return at;
}

#if defined(__x86_64__)

/// Shows the result the points of a leaf that are no farther than it has.
template <typename Result>
__attribute__((target("avx2"), always_inline)) inline void WideTree::visitLeaf(const OrderedCoordinates& points,
                                                                               const float* query, Leaf leaf,
                                                                               Result& result) {
  constexpr int kLanes = kChildren;  // derived: floats in a register
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  for (int k = 0; k < leaf.num_points; k += kLanes) {
    const std::int32_t first = leaf.first + k;
    const __m256 dx = _mm256_sub_ps(x, _mm256_loadu_ps(&points.x[first])),
                 dy = _mm256_sub_ps(y, _mm256_loadu_ps(&points.y[first])),
                 dz = _mm256_sub_ps(z, _mm256_loadu_ps(&points.z[first]));
    const __m256 sq = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    int near = _mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_set1_ps(result.worst()), _CMP_LE_OQ));
    near &= (1 << std::min(kLanes, leaf.num_points - k)) - 1;
    if (near == 0) continue;
    alignas(32) float sq_distances[kLanes];
    _mm256_store_ps(sq_distances, sq);
    for (; near != 0; near &= near - 1) {
      const int lane = __builtin_ctz(near);
      if (sq_distances[lane] <= result.worst()) result.offer(sq_distances[lane], first + lane);
    }
  }
}

/// The order of lanes in which some of them come first: moves all of them at once and without a branch, as how many
/// they are can not be foretold.
__attribute__((target("avx2"), always_inline)) inline __m256i orderOf(unsigned lanes) {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kLanesFirst.of[lanes].data())));
}

/// Adds those children of the nodes of some pairs that may hold a point no farther than a query has.
__attribute__((target("avx2"))) void WideTree::findChildren(const Points& queries, const std::vector<Closest>& closest,
                                                            const Pairs& at, Pairs& nodes, Pairs& leaves) const {
  for (Pairs* found : {&nodes, &leaves}) found->makeRoom(at.size * kChildren);
  const __m256 zero = _mm256_setzero_ps();
  for (std::size_t k = 0; k < at.size; ++k) {
    const std::int32_t i = at.queries[k];
    const Node& node = nodes_[static_cast<std::size_t>(at.children[k])];
    const float* const query = queries.col(i).data();
    const auto gap = [&](int axis) __attribute__((target("avx2"), always_inline)) {
      const __m256 x = _mm256_set1_ps(query[axis]);
      const __m256 below = _mm256_sub_ps(_mm256_loadu_ps(node.low[axis].data()), x);
      const __m256 above = _mm256_sub_ps(x, _mm256_loadu_ps(node.high[axis].data()));
      const __m256 wide = _mm256_max_ps(_mm256_max_ps(below, above), zero);
      return _mm256_mul_ps(wide, wide);
    };
    const __m256 sq = _mm256_add_ps(_mm256_add_ps(gap(0), gap(1)), gap(2));
    const __m256 limit = _mm256_set1_ps(closest[static_cast<std::size_t>(i)].sq_distance);
    const auto near = static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(sq, limit, _CMP_LE_OQ)));
    const __m256i children = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(node.children.data()));
    const auto is_leaf = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(children)));
    const auto add = [&](unsigned lanes, Pairs& to) __attribute__((target("avx2"), always_inline)) {
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(&to.children[to.size]),
                          _mm256_permutevar8x32_epi32(children, orderOf(lanes)));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(&to.queries[to.size]), _mm256_set1_epi32(i));
      to.size += static_cast<std::size_t>(__builtin_popcount(lanes));
    };
    add(near & ~is_leaf, nodes);
    add(near & is_leaf, leaves);
  }
}

/// The leaves that may hold a point no farther than the limit of a query.
const WideTree::Pairs& WideTree::findLeaves(const Points& queries, const std::vector<Closest>& limits,
                                            Storage& storage) const {
  Pairs &nodes = storage.nodes, &next = storage.next, &leaves = storage.leaves;
  leaves.size = 0;
  nodes.makeRoom(limits.size());
  nodes.size = limits.size();
  std::iota(nodes.queries.begin(), nodes.queries.begin() + static_cast<std::ptrdiff_t>(nodes.size), 0);
  std::fill_n(nodes.children.begin(), nodes.size, 0);
  while (nodes.size > 0) {
    next.size = 0;
    findChildren(queries, limits, nodes, next, leaves);
    std::swap(nodes, next);
  }
  return leaves;
}

__attribute__((target("avx2"))) void WideTree::findClosestOfMany(const OrderedCoordinates& points,
                                                                 const Points& queries, std::vector<Closest>& closest,
                                                                 Storage& storage) const {
  const Pairs& leaves = findLeaves(queries, closest, storage);
  for (std::size_t k = 0; k < leaves.size; ++k) {
    const std::int32_t i = leaves.queries[k];
    ClosestPlace result(closest[static_cast<std::size_t>(i)]);
    visitLeaf(points, queries.col(i).data(), leaves_[static_cast<std::size_t>(-1 - leaves.children[k])], result);
  }
}

/// Adds the points of a leaf that are no farther than the limit, as long as there is room.
__attribute__((target("avx2"))) void WideTree::addLeaf(const OrderedCoordinates& points, const float* query, Leaf leaf,
                                                       float sq_limit, Within& within) {
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  for (int k = 0; k < leaf.num_points && within.size <= 2 * kMostOfMany; k += kChildren) {
    const std::int32_t first = leaf.first + k;
    const __m256 dx = _mm256_sub_ps(x, _mm256_loadu_ps(&points.x[first])),
                 dy = _mm256_sub_ps(y, _mm256_loadu_ps(&points.y[first])),
                 dz = _mm256_sub_ps(z, _mm256_loadu_ps(&points.z[first]));
    const __m256 sq = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    auto lanes = static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_set1_ps(sq_limit), _CMP_LE_OQ)));
    lanes &= (1u << std::min(kChildren, leaf.num_points - k)) - 1u;
    const __m256i order = orderOf(lanes);
    const __m256i places = _mm256_add_epi32(_mm256_set1_epi32(first), order);
    _mm256_storeu_ps(&within.sq_distances[static_cast<std::size_t>(within.size)], _mm256_permutevar8x32_ps(sq, order));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(&within.places[static_cast<std::size_t>(within.size)]), places);
    within.size += __builtin_popcount(lanes);
  }
}

/// The nearest points within the distance of a query, in order: each goes to the place that the number of nearer ones
/// says.
/// \return whether these are they; not where there are too few or too many, or some are equally far away.
__attribute__((target("avx2"))) bool WideTree::putInOrder(Within& within, int most, std::int32_t* places,
                                                          float* sq_distances) {
  const int size = within.size;
  if (size < most || size > 2 * kMostOfMany) return false;
  constexpr float kNone = -1.0f;  // derived: squared distances are not negative
  std::array<float, Within::kRoom> sq_sorted;
  std::array<std::int32_t, Within::kRoom> sorted;
  sq_sorted.fill(kNone);
  const auto end = static_cast<std::size_t>(size);
  std::fill_n(&within.sq_distances[end], kChildren, std::numeric_limits<float>::infinity());
  for (std::size_t j = 0; j < end; ++j) {
    const __m256 own = _mm256_set1_ps(within.sq_distances[j]);
    int rank = 0;
    for (std::size_t k = 0; k < end; k += kChildren)
      rank += __builtin_popcount(static_cast<unsigned>(
          _mm256_movemask_ps(_mm256_cmp_ps(_mm256_loadu_ps(&within.sq_distances[k]), own, _CMP_LT_OQ))));
    sq_sorted[static_cast<std::size_t>(rank)] = within.sq_distances[j];
    sorted[static_cast<std::size_t>(rank)] = within.places[j];
  }
  // Of points equally far away all go to one place, and leave the next one empty.
  for (int k = 0; k < std::min(most + 1, size); ++k)
    if (sq_sorted[static_cast<std::size_t>(k)] == kNone) return false;
  std::copy_n(sq_sorted.begin(), most, sq_distances);
  std::copy_n(sorted.begin(), most, places);
  return true;
}

std::vector<char> WideTree::findNearestOfMany(const OrderedCoordinates& points, const Points& queries,
                                              const std::vector<Closest>& limits, int most, std::int32_t* places,
                                              float* sq_distances, Storage& storage) const {
  const Pairs& leaves = findLeaves(queries, limits, storage);
  std::vector<Within>& within = storage.within;
  if (within.size() < limits.size()) within.resize(limits.size());
  for (std::size_t i = 0; i < limits.size(); ++i) within[i].size = 0;
  for (std::size_t k = 0; k < leaves.size; ++k) {
    const auto i = static_cast<std::size_t>(leaves.queries[k]);
    addLeaf(points, queries.col(leaves.queries[k]).data(), leaves_[static_cast<std::size_t>(-1 - leaves.children[k])],
            limits[i].sq_distance, within[i]);
  }
  std::vector<char> is_open(limits.size());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(i) * most;
    is_open[i] = putInOrder(within[i], most, places + first, sq_distances + first) ? 0 : 1;
  }
  return is_open;
}

/// Shows the result the leaves that may hold points no farther than it has, near ones first.
/// \param pending storage.
template <typename Result>
__attribute__((target("avx2"))) void WideTree::visit(const OrderedCoordinates& points, const float* query,
                                                     Pending* const pending, Result& result) const {
  constexpr int kLanes = kChildren;  // derived: floats in a register
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  const __m256 zero = _mm256_setzero_ps();
  alignas(32) float sq_distances[kLanes];
  Pending* top = pending;
  std::int32_t child = 0;
  while (true) {
    if (child >= 0) {
      const Node& node = nodes_[static_cast<std::size_t>(child)];
      const auto gap = [&](int axis, __m256 at) __attribute__((target("avx2"), always_inline)) {
        const __m256 below = _mm256_sub_ps(_mm256_loadu_ps(node.low[axis].data()), at);
        const __m256 above = _mm256_sub_ps(at, _mm256_loadu_ps(node.high[axis].data()));
        const __m256 wide = _mm256_max_ps(_mm256_max_ps(below, above), zero);
        return _mm256_mul_ps(wide, wide);
      };
      // Rounded as the distances of points are: at most that of each point in the box.
      const __m256 sq = _mm256_add_ps(_mm256_add_ps(gap(0, x), gap(1, y)), gap(2, z));
      int near = _mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_set1_ps(result.worst()), _CMP_LE_OQ));
      if (near != 0) {
        _mm256_store_ps(sq_distances, sq);
        // The nearest child on top.
        Pending nearest{node.children[__builtin_ctz(near)], sq_distances[__builtin_ctz(near)]};
        for (near &= near - 1; near != 0; near &= near - 1) {
          const int k = __builtin_ctz(near);
          Pending other{node.children[k], sq_distances[k]};
          if (other.sq_distance < nearest.sq_distance) std::swap(other, nearest);
          *top++ = other;
        }
        child = nearest.child;
        continue;
      }
    } else {
      visitLeaf(points, query, leaves_[static_cast<std::size_t>(-1 - child)], result);
    }
    do {
      if (top == pending) return;
      --top;
    } while (top->sq_distance > result.worst());
    child = top->child;
  }
}

void WideTree::findClosest(const OrderedCoordinates& points, const float* query, std::vector<Pending>& pending,
                           Closest& closest) const {
  ClosestPlace result(closest);
  visit(points, query, pending.data(), result);
}

bool WideTree::findNearest(const OrderedCoordinates& points, const float* query, int most,
                           std::vector<Pending>& pending, std::int32_t* places, float* sq_distances) const {
  NearestPlaces result(places, sq_distances, most);
  visit(points, query, pending.data(), result);
  return result.isTied() || !result.isFull();
}

#else

void WideTree::findClosestOfMany(const OrderedCoordinates&, const Points&, std::vector<Closest>&, Storage&) const {}

std::vector<char> WideTree::findNearestOfMany(const OrderedCoordinates&, const Points&,
                                              const std::vector<Closest>& limits, int, std::int32_t*, float*,
                                              Storage&) const {
  return std::vector<char>(limits.size(), 1);
}

void WideTree::findClosest(const OrderedCoordinates&, const float*, std::vector<Pending>&, Closest&) const {}

bool WideTree::findNearest(const OrderedCoordinates&, const float*, int, std::vector<Pending>&, std::int32_t*,
                           float*) const {
  return true;
}

#endif

}  // namespace pcl_symmetry
