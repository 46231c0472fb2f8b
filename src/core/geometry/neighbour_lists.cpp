#include "core/geometry/neighbour_lists.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/wide_tree.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

// Share of the squared reach up to which a list decides. derived: (1 / 2)^2, less what distances are rounded by
// (relatively 1e-6).
constexpr float kDecidingShare = 0.2499f;
// Cells along each side of the grid where walks begin. chosen: at half, walks are longer, at twice, the grid takes
// longer to make than it saves.
constexpr int kStartCells = 32;
constexpr std::size_t kFilledPerBlock = 2048;  // lists. chosen: large enough that threads start seldom

}  // namespace

bool NeighbourLists::isUseful(Eigen::Index num_points) {
  return num_points > kNeighbours && num_points <= kMostPoints && WideTree::isSupported();
}

ClosestPointGrid NeighbourLists::starts(const Points& points) {
  return ClosestPointGrid(points, kStartCells);
}

NeighbourLists::NeighbourLists(const Points& points, const std::vector<int>& nearest,
                               const std::vector<float>& sq_reach)
    : NeighbourLists(starts(points), points, nearest, sq_reach, 1) {}

NeighbourLists::NeighbourLists(ClosestPointGrid starts, const Points& points, const std::vector<int>& nearest,
                               const std::vector<float>& sq_reach, int num_threads)
    : lists_(new List[static_cast<std::size_t>(points.cols())]), grid_(std::move(starts)) {
  parallelRanges(static_cast<std::size_t>(points.cols()), kFilledPerBlock, num_threads,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) fill(i, points, nearest, sq_reach[i]);
                 });
}

/// Fills the list of a point.
void NeighbourLists::fill(std::size_t i, const Points& points, const std::vector<int>& nearest, float sq_reach) {
  List& list = lists_[i];
  list = List();
  const auto own = points.col(static_cast<Eigen::Index>(i));
  list.own_x = own.x();
  list.own_y = own.y();
  list.own_z = own.z();
  list.most_sq_distance = kDecidingShare * sq_reach;
  // The point itself is among the nearest, unless as many others are at the same place.
  int count = 0;
  for (int k = 0; k <= kNeighbours && count < kNeighbours; ++k) {
    const int j = nearest[i * (kNeighbours + 1) + static_cast<std::size_t>(k)];
    if (j == static_cast<int>(i)) continue;
    list.x[count] = points(0, j);
    list.y[count] = points(1, j);
    list.z[count] = points(2, j);
    list.index[count++] = static_cast<std::uint16_t>(j);
  }
}

void NeighbourLists::walk(const PointsRef& queries, int* indices, float* sq_distances, char* is_closest) const {
  for (Eigen::Index begin = 0; begin < queries.cols(); begin += kTogether)
    walkSome(queries.middleCols(begin, std::min<Eigen::Index>(kTogether, queries.cols() - begin)), indices + begin,
             sq_distances + begin, is_closest + begin);
}

#if defined(__x86_64__)

/// \param queries at most kTogether.
__attribute__((target("avx2"))) void NeighbourLists::walkSome(const PointsRef& queries, int* indices,
                                                              float* sq_distances, char* is_closest) const {
  const auto num_queries = static_cast<int>(queries.cols());
  const float* const coordinates = queries.data();
  const std::ptrdiff_t stride = queries.outerStride();
  std::array<std::uint16_t, kTogether> walking;
  for (int i = 0; i < num_queries; ++i) {
    const List& list = lists_[static_cast<std::size_t>(indices[i])];
    const float* const query = coordinates + stride * i;
    const float dx = query[0] - list.own_x, dy = query[1] - list.own_y, dz = query[2] - list.own_z;
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
    __builtin_prefetch(list.x);
    walking[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(i);
  }
  for (int num_walking = num_queries; num_walking > 0;) {
    int num_on = 0;
    for (int w = 0; w < num_walking; ++w) {
      const int i = walking[static_cast<std::size_t>(w)];
      const List& list = lists_[static_cast<std::size_t>(indices[i])];
      const float* const query = coordinates + stride * i;
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
      const float sq_least = _mm_cvtss_f32(least), sq_before = sq_distances[i];
      const bool decides = sq_before <= list.most_sq_distance;
      const bool is_closer = sq_least < sq_before, is_alone = (lanes & (lanes - 1)) == 0;
      constexpr unsigned kLast = 1u << (kNeighbours - 1);  // derived: where distances are no numbers, no lane is set
      const int change = list.index[__builtin_ctz(lanes | kLast)] - indices[i];
      indices[i] += change & -static_cast<int>(is_closer);  // no branch: half of the guesses are the closest points
      sq_distances[i] = _mm_cvtss_f32(_mm_min_ss(least, _mm_set_ss(sq_before)));
      is_closest[i] = decides & ((is_closer & is_alone) | (sq_least > sq_before));
      const List& next = lists_[static_cast<std::size_t>(indices[i])];
      __builtin_prefetch(next.x);  // for the next round
      __builtin_prefetch(next.z);
      walking[static_cast<std::size_t>(num_on)] = static_cast<std::uint16_t>(i);
      num_on += is_closer & is_alone & !decides;
    }
    num_walking = num_on;
  }
}

#else

void NeighbourLists::walkSome(const PointsRef& queries, int*, float* sq_distances, char* is_closest) const {
  std::fill_n(sq_distances, queries.cols(), 0.0f);
  std::fill_n(is_closest, queries.cols(), 0);
}

#endif

}  // namespace pcl_symmetry
