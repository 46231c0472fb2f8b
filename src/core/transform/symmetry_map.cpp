#include "pcl_symmetry/core/symmetry_map.h"

#include <algorithm>

#include "core/transform/direction_rows.h"

namespace pcl_symmetry {

std::size_t SymmetryMap::strongest() const {
  return std::max_element(values.begin(), values.end()) - values.begin();
}

std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const PlaneGrid& grid = map.grid;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t d = 0; d < grid.numDirections(); ++d) normals.push_back(grid.normal(d).cast<float>());
  const DirectionRows rows(map.values, normals, grid.numRadius(), grid.radius());
  return rows.greatestThrough(normalizePoints(points, grid.center(), 1.0), num_threads);
}

}  // namespace pcl_symmetry
