#include <cmath>

#include "core/transform/direction_rows.h"
#include "pcl_symmetry/core/line_transform.h"

namespace pcl_symmetry {

std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const LineGrid& grid = map.grid;
  std::vector<Eigen::Vector3f> normals;
  for (int t = 0; t < grid.numTheta(); ++t)
    normals.push_back(Eigen::Vector3d(std::cos(grid.theta(t)), std::sin(grid.theta(t)), 0.0).cast<float>());
  const DirectionRows rows(map.values, normals, grid.numRadius(), grid.radius());
  Points embedded = Points::Zero(3, points.cols());
  embedded.topRows<2>() = (points.cast<double>().colwise() - grid.center()).cast<float>();
  return rows.greatestThrough(embedded, num_threads);
}

}  // namespace pcl_symmetry
