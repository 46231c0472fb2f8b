#include <cmath>

#include "core/transform/direction_rows.h"
#include "pcl_symmetry/core/transform_2d/line_transform.h"

namespace pcl_symmetry {

std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const LineGrid& grid = map.grid;
  const DirectionRows directions(map.values, grid.numTheta(), grid.numRadius(), grid.radius(), [&](std::size_t t) {
    const double theta = grid.theta(static_cast<int>(t));
    return Eigen::Vector3d(std::cos(theta), std::sin(theta), 0.0).cast<float>().eval();
  });
  Points embedded = Points::Zero(3, points.cols());
  embedded.topRows<2>() = (points.cast<double>().colwise() - grid.center()).cast<float>();
  return greatestThrough(directions, embedded, num_threads);
}

}  // namespace pcl_symmetry
