#include "core/detection/far_test.h"

#include <array>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

/// The frame of the cells, as plain numbers.
struct CellFrame {
  double center[3], origin[3];
  double scale, cell_size;
  int num_cells;
};

/// Indices of the cells that contain points; -1 where a point lies outside the grid.
/// \param points three coordinates each.
PCL_SYMMETRY_MULTIVERSION
void cellsOf(const float* points, int size, const CellFrame& frame, std::int32_t* cells) {
  const double scale = frame.scale, cell_size = frame.cell_size, end = frame.num_cells, last = end - 1.0;
  const double c0 = frame.center[0], c1 = frame.center[1], c2 = frame.center[2];
  const double o0 = frame.origin[0], o1 = frame.origin[1], o2 = frame.origin[2];
  const std::int32_t n = frame.num_cells;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const double x = (static_cast<double>(points[3 * i]) * scale + c0 - o0) / cell_size + 0.5,
                 y = (static_cast<double>(points[3 * i + 1]) * scale + c1 - o1) / cell_size + 0.5,
                 z = (static_cast<double>(points[3 * i + 2]) * scale + c2 - o2) / cell_size + 0.5;
    const bool inside = (x >= 0.0) & (y >= 0.0) & (z >= 0.0) & (x < end) & (y < end) & (z < end);
    const auto at = [=](double coordinate) {
      const double kept = coordinate < 0.0 ? 0.0 : coordinate;
      return static_cast<std::int32_t>(kept > last ? last : kept);
    };
    const std::int32_t cell = (at(z) * n + at(y)) * n + at(x);
    cells[i] = inside ? cell : -1;
  }
}

}  // namespace

std::vector<Eigen::Index> FarTest::nearOf(const PointsRef& points, float bound) const {
  constexpr int kTogether = 256;  // points. Their cells stay in the first cache
  CellFrame frame{{}, {}, scale_, edt_.cellSize(), edt_.numCells()};
  for (int k = 0; k < 3; ++k) {
    frame.center[k] = center_[k];
    frame.origin[k] = edt_.origin()[k];
  }
  const float least = std::min(bound, kFarthest);
  const float* const values = edt_.values().data();
  std::array<std::int32_t, kTogether> cells;
  std::vector<Eigen::Index> near(static_cast<std::size_t>(points.cols()));
  std::size_t count = 0;
  for (Eigen::Index begin = 0; begin < points.cols(); begin += kTogether) {
    const int size = static_cast<int>(std::min<Eigen::Index>(kTogether, points.cols() - begin));
    cellsOf(points.data() + 3 * begin, size, frame, cells.data());
    for (int i = 0; i < size; ++i) {
      near[count] = begin + i;
      count += cells[i] >= 0 && values[cells[i]] > least ? 1 : 0;
    }
  }
  near.resize(count);
  return near;
}

ClosestPoints closestWithin(const IspSurface& surface, const Points& queries, double reach,
                            const std::vector<int>* guesses, bool leaves_out) {
  const auto size = static_cast<std::size_t>(queries.cols());
  ClosestPoints found{std::vector<int>(size, -1), std::vector<float>(size, std::numeric_limits<float>::infinity())};
  const float bound = surface.far ? surface.far->bound(reach) : 0.0f;
  const bool has_far = surface.far && (leaves_out || FarTest::isExact(bound));
  const auto sq_reach = static_cast<float>(reach * reach);
  parallelRanges(size, 1024, surface.num_threads, [&](std::size_t begin, std::size_t end) {
    if (!has_far && size <= 1024) {  // all at once
      if (guesses) found.indices = *guesses;
      surface.search.searchWithin(queries, sq_reach, found.indices, found.sq_distances);
      return;
    }
    const auto some = queries.middleCols(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
    std::vector<Eigen::Index> near;  // from begin on
    if (has_far) {
      near = surface.far->nearOf(some, bound);
    } else {
      near.resize(end - begin);
      std::iota(near.begin(), near.end(), Eigen::Index{0});
    }
    Points asked(3, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) asked.col(i) = some.col(near[i]);
    std::vector<int> closest(near.size(), -1);
    std::vector<float> sq_distances;
    if (guesses)
      for (std::size_t i = 0; i < near.size(); ++i) closest[i] = (*guesses)[begin + near[i]];
    surface.search.searchWithin(asked, sq_reach, closest, sq_distances);
    for (std::size_t i = 0; i < near.size(); ++i) {
      found.indices[begin + near[i]] = closest[i];
      found.sq_distances[begin + near[i]] = sq_distances[i];
    }
  });
  return found;
}

}  // namespace pcl_symmetry
