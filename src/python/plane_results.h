/// What planes() of the Python module returns.
#pragma once

#include <pybind11/numpy.h>

#include <optional>
#include <vector>

#include "pcl_symmetry/core/detection/plane_detection.h"

namespace pcl_symmetry::python {

/// A detection, and what it says of the rows of the array.
struct PlaneSearch {
  Detection found;
  std::optional<Eigen::Vector3d> viewpoint;             ///< that was used, frame of the points
  std::vector<pybind11::array_t<float>> point_support;  ///< for each plane one value per row, NaN for rows not used
};

/// Adds the classes Plane, Axis, Center, View and Planes to the module.
void addPlaneResults(pybind11::module_& module);

}  // namespace pcl_symmetry::python
