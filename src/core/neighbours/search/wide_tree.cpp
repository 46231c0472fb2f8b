#include "core/neighbours/search/wide_tree.h"

#include <algorithm>
#include <limits>
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

}  // namespace

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
      const Leaf leaf = leaves_[static_cast<std::size_t>(-1 - child)];
      for (int k = 0; k < leaf.num_points; k += kLanes) {
        const std::int32_t first = leaf.first + k;
        const __m256 dx = _mm256_sub_ps(x, _mm256_loadu_ps(&points.x[first])),
                     dy = _mm256_sub_ps(y, _mm256_loadu_ps(&points.y[first])),
                     dz = _mm256_sub_ps(z, _mm256_loadu_ps(&points.z[first]));
        const __m256 sq =
            _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
        int near = _mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_set1_ps(result.worst()), _CMP_LE_OQ));
        near &= (1 << std::min(kLanes, leaf.num_points - k)) - 1;
        if (near == 0) continue;
        _mm256_store_ps(sq_distances, sq);
        for (; near != 0; near &= near - 1) {
          const int lane = __builtin_ctz(near);
          if (sq_distances[lane] <= result.worst()) result.offer(sq_distances[lane], first + lane);
        }
      }
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

void WideTree::findClosest(const OrderedCoordinates&, const float*, std::vector<Pending>&, Closest&) const {}

bool WideTree::findNearest(const OrderedCoordinates&, const float*, int, std::vector<Pending>&, std::int32_t*,
                           float*) const {
  return true;
}

#endif

}  // namespace pcl_symmetry
