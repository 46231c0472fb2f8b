#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Where the scanner stood.
struct Viewpoint {
  enum class Mode {
    Auto,  ///< decided from the data: by the rays of an organized cloud, else by a sensor_origin_ that can be true
    None,  ///< nowhere: the cloud shows the object from all sides
    Given  ///< at position
  };
  Mode mode = Mode::Auto;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< input frame and units; used with Mode::Given
};

}  // namespace pcl_symmetry
