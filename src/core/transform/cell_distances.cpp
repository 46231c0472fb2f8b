#include "core/transform/cell_distances.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr int cube_side = 8;  // cells of a block, a multiple of a part
constexpr int part_side = 4;  // cells; a slice of a part fills an AVX-512 register
constexpr int bin_side = 4;   // cells of a bin of points
constexpr int cells_in_slice = part_side * part_side;
constexpr int cells_in_part = cells_in_slice * part_side;

constexpr float slack_of_distance = 1e-3f;  // cells; more than distances are rounded by
constexpr float slack_share = 1e-5f;        // the same of squared distances

struct Coordinates {
  const float *x, *y, *z;
};

/// Squared distances of points from a place.
/// \param index_bits ones where indices of the points have bits.
/// \return the least of (bits of the squared distance, but for index_bits, and the index of the point).
PCL_SYMMETRY_MULTIVERSION
std::int32_t sqDistancesFrom(const float* from, const Coordinates& points, int size, std::int32_t index_bits,
                             float* sq_distances) {
  const float cx = from[0], cy = from[1], cz = from[2];
  const float *const x = points.x, *const y = points.y, *const z = points.z;
  std::int32_t least = INT32_MAX;
  for (int i = 0; i < size; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float sq_distance = dx * dx + dy * dy + dz * dz;
    sq_distances[i] = sq_distance;
    std::int32_t bits;
    std::memcpy(&bits, &sq_distance, sizeof bits);
    least = std::min(least, (bits & ~index_bits) | i);
  }
  return least;
}

/// Which points may be nearer than point q to a place of a cube.
/// \param half half the side of the cube.
/// \param sq_distances from the center of the cube.
/// \param[out] marks 1: may be.
PCL_SYMMETRY_MULTIVERSION
void markNearer(int q, float half, const Coordinates& points, const float* sq_distances, int size,
                std::int32_t* marks) {
  const float *const x = points.x, *const y = points.y, *const z = points.z;
  const float qx = x[q], qy = y[q], qz = z[q], most = sq_distances[q] * (1.0f + slack_share) + slack_of_distance;
  for (int i = 0; i < size; ++i) {
    // |p - u|^2 - |q - u|^2 is linear in u: least in a corner of the cube.
    const float gain = 2.0f * half * (std::abs(x[i] - qx) + std::abs(y[i] - qy) + std::abs(z[i] - qz));
    marks[i] = sq_distances[i] * (1.0f - slack_share) - gain <= most ? 1 : 0;
  }
}

/// Values of the cells of a slice of a part.
typedef float SliceOfPart __attribute__((vector_size(cells_in_slice * sizeof(float))));

/// Squared distances of the cells of a part from the nearest of some points.
/// \param first the center of the first cell.
/// \param chosen the points.
/// \param[in,out] nearest cells_in_part values, x slowest, y fastest.
PCL_SYMMETRY_MULTIVERSION
void lower(const float* first, const Coordinates& points, const std::int32_t* chosen, int size, float* nearest) {
  SliceOfPart y, z, low[part_side];
  for (int l = 0; l < cells_in_slice; ++l) {
    y[l] = first[1] + static_cast<float>(l % part_side);
    z[l] = first[2] + static_cast<float>(l / part_side);
  }
  std::memcpy(low, nearest, sizeof low);
  const float x0 = first[0], x1 = x0 + 1.0f, x2 = x0 + 2.0f, x3 = x0 + 3.0f;
  for (int i = 0; i < size; ++i) {
    const float px = points.x[chosen[i]], py = points.y[chosen[i]], pz = points.z[chosen[i]];
    const SliceOfPart dy = y - py, dz = z - pz, sq_across = dz * dz + dy * dy;
    const auto lowered = [&](SliceOfPart & slice, float dx) __attribute__((always_inline)) {
      const SliceOfPart sq_distance = sq_across + dx * dx;
      slice = sq_distance < slice ? sq_distance : slice;
    };
    lowered(low[0], x0 - px);
    lowered(low[1], x1 - px);
    lowered(low[2], x2 - px);
    lowered(low[3], x3 - px);
  }
  std::memcpy(nearest, low, sizeof low);
}

}  // namespace

/// Points, and which of them may be nearest to a cell of a cube.
struct CellDistances::Candidates {
  std::vector<float> x, y, z, sq_distances;
  std::vector<std::int32_t> marks, chosen;
  int size = 0, num_chosen = 0;

  Coordinates coordinates() const { return {x.data(), y.data(), z.data()}; }

  void makeRoom(int most) {
    if (static_cast<int>(x.size()) >= most) return;
    for (auto* values : {&x, &y, &z, &sq_distances}) values->resize(static_cast<std::size_t>(2 * most));
    for (auto* values : {&marks, &chosen}) values->resize(static_cast<std::size_t>(2 * most));
  }

  /// Chooses those that may be nearest to a place of a cube.
  /// \param center,half of the cube, and half its side.
  /// \param sq_most squared distance from the center beyond which none is chosen.
  void choose(const float* center, float half, float sq_most) {
    num_chosen = 0;
    std::int32_t index_bits = 1;
    while (index_bits < size) index_bits = 2 * index_bits + 1;
    const std::int32_t least = sqDistancesFrom(center, coordinates(), size, index_bits, sq_distances.data());
    const std::int32_t bits = least & ~index_bits;
    float sq_least;
    std::memcpy(&sq_least, &bits, sizeof bits);
    if (size == 0 || sq_least > sq_most) return;
    markNearer(least & index_bits, half, coordinates(), sq_distances.data(), size, marks.data());
    const std::int32_t* const mark = marks.data();
    std::int32_t* const to = chosen.data();
    int count = 0;
    for (int i = 0; i < size; ++i) {
      to[count] = i;
      count += mark[i];
    }
    num_chosen = count;
  }

  /// Takes the points that others have chosen.
  void take(const Candidates& other) {
    makeRoom(other.num_chosen);
    size = other.num_chosen;
    for (int k = 0; k < size; ++k) {
      x[k] = other.x[other.chosen[k]];
      y[k] = other.y[other.chosen[k]];
      z[k] = other.z[other.chosen[k]];
    }
  }
};

CellDistances::CellDistances(const Points& points, int num_cells, float reach)
    : num_cells_(num_cells),
      num_blocks_((num_cells + cube_side - 1) / cube_side),
      num_bins_((num_cells + bin_side - 1) / bin_side),
      sq_reach_(reach * reach),
      reach_(reach),
      begin_(static_cast<std::size_t>(num_bins_) * num_bins_ * num_bins_ + 1, 0) {
  const auto size = static_cast<std::size_t>(points.cols());
  std::vector<int> bins(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto p = points.col(static_cast<Eigen::Index>(i));
    bins[i] = (bin(p.z()) * num_bins_ + bin(p.y())) * num_bins_ + bin(p.x());
    ++begin_[static_cast<std::size_t>(bins[i]) + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<int> next(begin_);
  for (auto* coordinates : {&x_, &y_, &z_}) coordinates->resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(bins[i])]++);
    const auto p = points.col(static_cast<Eigen::Index>(i));
    x_[place] = p.x();
    y_[place] = p.y();
    z_[place] = p.z();
  }
}

/// The bin of a coordinate in cells; that at the side for what lies beyond.
int CellDistances::bin(float coordinate) const {
  return static_cast<int>(std::clamp(coordinate, 0.0f, static_cast<float>(num_cells_ - 1))) / bin_side;
}

/// The points of the bins within reach of a block.
void CellDistances::gather(const Block& block, Candidates& found) const {
  struct Range {
    int low, high;
  };
  const auto within = [&](int first) {
    return Range{bin(static_cast<float>(first) - reach_), bin(static_cast<float>(first + cube_side - 1) + reach_)};
  };
  const Range x = within(block.x), y = within(block.y), z = within(block.z);
  found.size = 0;
  for (int bin_z = z.low; bin_z <= z.high; ++bin_z) {
    for (int bin_y = y.low; bin_y <= y.high; ++bin_y) {
      const int* const row = begin_.data() + (static_cast<std::ptrdiff_t>(bin_z) * num_bins_ + bin_y) * num_bins_;
      const int begin = row[x.low], count = row[x.high + 1] - begin;
      if (count == 0) continue;
      found.makeRoom(found.size + count);
      std::copy_n(x_.begin() + begin, count, found.x.begin() + found.size);
      std::copy_n(y_.begin() + begin, count, found.y.begin() + found.size);
      std::copy_n(z_.begin() + begin, count, found.z.begin() + found.size);
      found.size += count;
    }
  }
}

void CellDistances::fill(int row, float* sq_distances) const {
  Candidates found, near;
  for (int x = 0; x < num_cells_; x += cube_side)
    fillBlock({x, row % num_blocks_ * cube_side, row / num_blocks_ * cube_side}, found, near, sq_distances);
}

void CellDistances::fillBlock(const Block& block, Candidates& found, Candidates& near, float* sq_distances) const {
  const auto choose = [&](const Block& cube, int side, Candidates& from) {
    const float half = 0.5f * static_cast<float>(side - 1), most = reach_ + std::sqrt(3.0f) * half + slack_of_distance;
    const float center[] = {static_cast<float>(cube.x) + half, static_cast<float>(cube.y) + half,
                            static_cast<float>(cube.z) + half};
    from.choose(center, half, most * most);
  };
  gather(block, found);
  choose(block, cube_side, found);
  near.take(found);
  for (int z = block.z; z < std::min(block.z + cube_side, num_cells_); z += part_side)
    for (int y = block.y; y < std::min(block.y + cube_side, num_cells_); y += part_side)
      for (int x = block.x; x < std::min(block.x + cube_side, num_cells_); x += part_side) {
        choose({x, y, z}, part_side, near);
        fillPart({x, y, z}, near, sq_distances);
      }
}

void CellDistances::fillPart(const Block& part, const Candidates& near, float* sq_distances) const {
  float nearest[cells_in_part];
  std::fill_n(nearest, cells_in_part, sq_reach_);
  const float first[] = {static_cast<float>(part.x), static_cast<float>(part.y), static_cast<float>(part.z)};
  if (near.num_chosen > 0) lower(first, near.coordinates(), near.chosen.data(), near.num_chosen, nearest);
  const int width = std::min(part_side, num_cells_ - part.x), height = std::min(part_side, num_cells_ - part.y),
            depth = std::min(part_side, num_cells_ - part.z);
  for (int z = 0; z < depth; ++z)
    for (int y = 0; y < height; ++y) {
      float* const row =
          sq_distances + (static_cast<std::size_t>(part.z + z) * num_cells_ + part.y + y) * num_cells_ + part.x;
      for (int x = 0; x < width; ++x) row[x] = nearest[x * cells_in_slice + z * part_side + y];
    }
}

}  // namespace pcl_symmetry
