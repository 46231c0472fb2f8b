#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Where the scanner stood.
struct Viewpoint {
  enum class Mode {
    Auto,  ///< decided from the data: see ViewpointSource
    None,  ///< nowhere: the cloud shows the object from all sides
    Given  ///< at position
  };
  Mode mode = Mode::Auto;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< input frame and units; used with Mode::Given
};

/// Where an analysis has its viewpoint from. Mode::Auto tries Rays, Stored and Inferred in this order.
enum class ViewpointSource {
  None,     ///< it used none
  Given,    ///< from the user
  Rays,     ///< from the rows and columns of an organized cloud
  Stored,   ///< from sensor_origin_, and the points can have been seen from there
  Inferred  ///< from the density of the points: that of a scan falls with the slant and the distance of the surface
};

}  // namespace pcl_symmetry
