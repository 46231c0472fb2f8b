#include "core/transform/cell_distances.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr int part_side =
    4;  // cells of a part of the cube, and of a bin of points; its slices fill an AVX-512 register
constexpr int cells_in_slice = part_side * part_side;

/// Squared distances of points from a position.
/// \return bits of the least, which are in the order of the values.
PCL_SYMMETRY_MULTIVERSION
std::int32_t sqDistancesFrom(const float* from, const float* x, const float* y, const float* z, int size,
                             float* sq_distances) {
  const float cx = from[0], cy = from[1], cz = from[2];
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (int i = 0; i < size; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
    std::int32_t bits;
    std::memcpy(&bits, sq_distances + i, sizeof bits);
    least = std::min(least, bits);
  }
  return least;
}

/// Lowers squared distances of the cells of a part to those from the nearest of some points.
/// \param first the center of the first cell.
/// \param chosen indices of the points.
/// \param[in,out] nearest part_side slices of cells_in_slice values, x slowest, y fastest.
PCL_SYMMETRY_MULTIVERSION
void lower(const float* first, const float* px, const float* py, const float* pz, const int* chosen, int size,
           float* nearest) {
  typedef float Slice __attribute__((vector_size(cells_in_slice * sizeof(float))));
  Slice y, z, low[part_side];
  for (int l = 0; l < cells_in_slice; ++l) {
    y[l] = first[1] + static_cast<float>(l % part_side);
    z[l] = first[2] + static_cast<float>(l / part_side);
  }
  std::memcpy(low, nearest, sizeof low);
  for (int i = 0; i < size; ++i) {
    const Slice dy = y - py[chosen[i]], dz = z - pz[chosen[i]], sq_across = dz * dz + dy * dy;
    for (int k = 0; k < part_side; ++k) {
      const float dx = first[0] + static_cast<float>(k) - px[chosen[i]];
      const Slice sq_distance = sq_across + dx * dx;
      low[k] = sq_distance < low[k] ? sq_distance : low[k];
    }
  }
  std::memcpy(nearest, low, sizeof low);
}

/// Points in bins of part_side cells, bin by bin, x fastest. Those beyond the cube are in the bins at its sides.
struct BinnedPoints {
  BinnedPoints(const Points& points, int cells)
      : num_cells(cells),
        num_bins((cells + part_side - 1) / part_side),
        begin(static_cast<std::size_t>(num_bins) * num_bins * num_bins + 1, 0) {
    std::vector<std::size_t> bins;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const auto p = points.col(i);
      bins.push_back((static_cast<std::size_t>(bin(p.z())) * num_bins + bin(p.y())) * num_bins + bin(p.x()));
      ++begin[bins.back() + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> next(begin);
    for (auto* coordinates : {&x, &y, &z}) coordinates->resize(bins.size());
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const int position = next[bins[i]]++;
      x[position] = points(0, static_cast<Eigen::Index>(i));
      y[position] = points(1, static_cast<Eigen::Index>(i));
      z[position] = points(2, static_cast<Eigen::Index>(i));
    }
  }

  int bin(float coordinate) const {
    return static_cast<int>(std::clamp(coordinate, 0.0f, static_cast<float>(num_cells - 1))) / part_side;
  }

  /// Calls visit(from, to) for runs of the points that are in bins within reach of a part.
  template <typename Visit>
  void visitNear(const float* first, float reach, const Visit& visit) const {
    const auto low = [&](int axis) { return bin(first[axis] - reach); };
    const auto high = [&](int axis) { return bin(first[axis] + static_cast<float>(part_side - 1) + reach); };
    for (int bin_z = low(2); bin_z <= high(2); ++bin_z)
      for (int bin_y = low(1); bin_y <= high(1); ++bin_y) {
        const int* const row = begin.data() + (static_cast<std::ptrdiff_t>(bin_z) * num_bins + bin_y) * num_bins;
        if (row[low(0)] < row[high(0) + 1]) visit(row[low(0)], row[high(0) + 1]);
      }
  }

  int num_cells, num_bins;
  std::vector<int> begin;  ///< first point of each bin
  std::vector<float> x, y, z;
};

}  // namespace

/// Each part of the cube is compared with the points that may be nearest to one of its cells.
std::vector<float> sqCellDistances(const Points& points, int num_cells, float reach, int num_threads) {
  const int n = num_cells;
  const BinnedPoints binned(points, n);
  std::vector<float> result(static_cast<std::size_t>(n) * n * n);
  const auto num_parts = static_cast<std::size_t>(binned.num_bins);
  parallelBlocks(num_parts * num_parts, num_threads, [&](std::size_t row) {
    std::vector<float> sq_distances;
    std::vector<int> near, chosen;
    for (int first_x = 0; first_x < n; first_x += part_side) {
      const int first_y = static_cast<int>(row % num_parts) * part_side,
                first_z = static_cast<int>(row / num_parts) * part_side;
      const float first[] = {static_cast<float>(first_x), static_cast<float>(first_y), static_cast<float>(first_z)};
      constexpr float half = 0.5f * (part_side - 1), half_diagonal = 1.7320508f * half, slack = 1e-3f;
      const float center[] = {first[0] + half, first[1] + half, first[2] + half};
      std::int32_t bits = std::numeric_limits<std::int32_t>::max();
      near.clear();
      binned.visitNear(first, reach, [&](int from, int to) {
        const std::size_t before = near.size();
        for (int i = from; i < to; ++i) near.push_back(i);
        if (sq_distances.size() < near.size()) sq_distances.resize(2 * near.size());
        bits = std::min(bits, sqDistancesFrom(center, &binned.x[from], &binned.y[from], &binned.z[from], to - from,
                                              &sq_distances[before]));
      });
      // The point nearest to a cell is not farther from the center than the one nearest to the center and a diagonal.
      float sq_least;
      std::memcpy(&sq_least, &bits, sizeof bits);
      const float most =
          near.empty() ? 0.0f : std::min(std::sqrt(sq_least) + half_diagonal, reach) + half_diagonal + slack;
      chosen.resize(near.size());
      int num_chosen = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        chosen[num_chosen] = near[i];
        num_chosen += sq_distances[i] <= most * most ? 1 : 0;
      }
      float nearest[part_side * cells_in_slice];
      std::fill(std::begin(nearest), std::end(nearest), reach * reach);
      lower(first, binned.x.data(), binned.y.data(), binned.z.data(), chosen.data(), num_chosen, nearest);
      for (int z = first_z; z < std::min(first_z + part_side, n); ++z)
        for (int y = first_y; y < std::min(first_y + part_side, n); ++y)
          for (int x = first_x; x < std::min(first_x + part_side, n); ++x)
            result[(static_cast<std::size_t>(z) * n + y) * n + x] =
                nearest[(x - first_x) * cells_in_slice + (z - first_z) * part_side + y - first_y];
    }
  });
  return result;
}

}  // namespace pcl_symmetry
