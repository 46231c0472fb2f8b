#include "pcl_symmetry/core/transform/symmetry_map.h"

#include "core/transform/direction_rows.h"

namespace pcl_symmetry {

std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const PlaneGrid& grid = map.grid;
  const DirectionRows directions(
      map.values, grid.numDirections(), grid.numRadius(), grid.radius(), [&](std::size_t d) -> Eigen::Vector3f {
        return grid.normal(static_cast<int>(d / grid.numPhi()), static_cast<int>(d % grid.numPhi())).cast<float>();
      });
  return greatestThrough(directions, normalizePoints(points, grid.center(), 1.0), num_threads);
}

}  // namespace pcl_symmetry
