#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/geometry/closest_point_grid.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// A grid of closest points that is made when it is first asked for: a surface that is judged exactly needs none. May
/// be asked by several threads at once.
class LateGrid {
public:
  explicit LateGrid(int num_cells) : num_cells_(num_cells) {}

  /// \param points the same each time, 3 x N, finite, N >= 1.
  const ClosestPointGrid& of(const PointsRef& points);

private:
  int num_cells_;
  std::once_flag made_;
  std::optional<ClosestPointGrid> grid_;
};

/// One of two clouds that are brought together, with everything that judging a pose needs.
struct PosedSurface {
  Points points;                   ///< 3 x N
  Points normals;                  ///< 3 x N, unit, of any sign
  std::vector<float> spacing;      ///< N, distance between neighboring samples there
  std::vector<int> order;          ///< N, the points in random order: the first k are an even sample of the surface
  double accuracy = 0.0;           ///< distance within which samples of one surface meet: their spacing and their noise
  double noise = 0.0;              ///< scatter of the samples about the surface
  std::optional<Visibility> seen;  ///< what the scanner saw; nothing = the cloud shows its object from all sides
  std::shared_ptr<LateGrid> grid;  ///< shared by copies of the surface
  ClosestPointSearch::Ptr search;

  /// \param points 3 x N, finite, N >= 1.
  /// \param seen what the scanner saw, in the frame of the points.
  /// \param seed of the order.
  /// \param num_threads >= 0; 0 = one per core.
  PosedSurface(const PointsRef& points, std::optional<Visibility> seen, std::uint64_t seed, int num_threads);
  /// A surface of a few points in random order, whose normals are known, for poses that are judged coarsely: the grid
  /// of closest points is coarser, and there are no search, spacing and accuracy, which exact judgments need.
  PosedSurface(const PointsRef& points, const PointsRef& normals, std::optional<Visibility> seen);
};

}  // namespace pcl_symmetry
