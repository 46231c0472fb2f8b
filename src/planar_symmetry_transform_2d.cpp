#include "pcl_symmetry/planar_symmetry_transform_2d.h"

#include "core/geometry/principal_axes.h"

namespace pcl_symmetry::detail {

Sheet sheetOf(const Points& points) {
  Sheet sheet;
  sheet.T_input_sheet = sheetPose(points);
  sheet.points = (sheet.T_input_sheet.inverse() * points.cast<double>()).topRows<2>().cast<float>();
  return sheet;
}

}  // namespace pcl_symmetry::detail
