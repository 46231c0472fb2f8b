#include "pcl_symmetry/core/symmetry_map.h"

#include <algorithm>

#include "core/base/simd.h"
#include "core/transform/direction_rows.h"

namespace pcl_symmetry {

namespace {

/// \return the greatest of some values, all of them numbers.
PCL_SYMMETRY_MULTIVERSION
float greatestOf(const float* values, std::size_t size) {
  constexpr std::size_t num_lanes = 32;  // two AVX-512 registers, which do not wait for each other
  float lanes[num_lanes];
  for (float& lane : lanes) lane = values[0];
  std::size_t i = 0;
  for (; i + num_lanes <= size; i += num_lanes)
    for (std::size_t k = 0; k < num_lanes; ++k) lanes[k] = lanes[k] < values[i + k] ? values[i + k] : lanes[k];
  float greatest = lanes[0];
  for (const float lane : lanes) greatest = std::max(greatest, lane);
  for (; i < size; ++i) greatest = std::max(greatest, values[i]);
  return greatest;
}

}  // namespace

std::size_t SymmetryMap::strongest() const {
  if (values.empty()) return 0;
  return std::find(values.begin(), values.end(), greatestOf(values.data(), values.size())) - values.begin();
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
