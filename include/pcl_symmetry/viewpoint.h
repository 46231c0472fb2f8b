#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// Where the scanner stood.
struct Viewpoint {
  enum class Mode {
    Auto,  ///< decided from the data: the rays of an organized cloud, else its sensor_origin_ where that is true
    None,  ///< nowhere: the cloud shows the object from all sides
    Given  ///< at position
  };
  Mode mode = Mode::Auto;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< input frame and units
};

}  // namespace pcl_symmetry
