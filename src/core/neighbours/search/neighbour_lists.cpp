#include "core/neighbours/search/neighbour_lists.h"

#include "core/neighbours/search/wide_tree.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

// Share of the squared reach up to which a list decides. derived: (1 / 2)^2, less what distances are rounded by
// (relatively 1e-6).
constexpr float kDecidingShare = 0.2499f;

}  // namespace

bool NeighbourLists::isUseful(Eigen::Index num_points) {
  return num_points > kNeighbours && num_points <= kMostPoints && WideTree::isSupported();
}

NeighbourLists::NeighbourLists(const Points& points, const std::vector<int>& nearest,
                               const std::vector<float>& sq_reach)
    : lists_(static_cast<std::size_t>(points.cols())), places_(lists_.size()) {
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    const auto p = points.col(static_cast<Eigen::Index>(i));
    places_[i] = {p.x(), p.y(), p.z(), kDecidingShare * sq_reach[i]};
    List& list = lists_[i];
    // The point itself is among the nearest, unless as many others are at the same place.
    int count = 0;
    for (int k = 0; k <= kNeighbours && count < kNeighbours; ++k) {
      const int j = nearest[i * (kNeighbours + 1) + static_cast<std::size_t>(k)];
      if (j == static_cast<int>(i)) continue;
      list.x[count] = points(0, j);
      list.y[count] = points(1, j);
      list.z[count] = points(2, j);
      list.index[count++] = j;
    }
  }
}

#if defined(__x86_64__)

__attribute__((target("avx2"))) NeighbourLists::Answer NeighbourLists::closest(const float* query, int guess) const {
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  const Place* place = &places_[static_cast<std::size_t>(guess)];
  const float dx = query[0] - place->x, dy = query[1] - place->y, dz = query[2] - place->z;
  Answer answer{guess, dx * dx + dy * dy + dz * dz, false};
  while (true) {
    const bool decides = answer.sq_distance <= place->most_sq_distance;
    const List& list = lists_[static_cast<std::size_t>(answer.index)];
    const __m256 ax = _mm256_sub_ps(x, _mm256_loadu_ps(list.x)), ay = _mm256_sub_ps(y, _mm256_loadu_ps(list.y)),
                 az = _mm256_sub_ps(z, _mm256_loadu_ps(list.z));
    const __m256 sq = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ax, ax), _mm256_mul_ps(ay, ay)), _mm256_mul_ps(az, az));
    __m128 least = _mm_min_ps(_mm256_castps256_ps128(sq), _mm256_extractf128_ps(sq, 1));
    least = _mm_min_ps(least, _mm_movehl_ps(least, least));
    least = _mm_min_ss(least, _mm_movehdup_ps(least));
    const float sq_least = _mm_cvtss_f32(least);
    if (sq_least > answer.sq_distance) {
      answer.is_closest = decides;
      return answer;
    }
    if (!(sq_least < answer.sq_distance)) return answer;  // as far away, or no number
    const auto lanes =
        static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(sq, _mm256_broadcastss_ps(least), _CMP_EQ_OQ)));
    answer.index = list.index[__builtin_ctz(lanes)];
    answer.sq_distance = sq_least;
    if (decides || (lanes & (lanes - 1)) != 0) {
      answer.is_closest = decides && (lanes & (lanes - 1)) == 0;
      return answer;
    }
    place = &places_[static_cast<std::size_t>(answer.index)];
  }
}

#else

NeighbourLists::Answer NeighbourLists::closest(const float*, int guess) const {
  return {guess, 0.0f, false};
}

#endif

}  // namespace pcl_symmetry
