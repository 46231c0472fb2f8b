/// The classes of results: plain values, of which the package makes its own results.
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/detection/detection_evidence.h"

namespace pcl_symmetry::python {

/// A detection, and the rows of the array that its points were.
struct PlaneSearch {
  Detection found;
  DetectionEvidence evidence;                ///< empty where it was not wanted
  std::optional<Eigen::Vector3d> viewpoint;  ///< that was used, frame of the points
  std::vector<std::size_t> rows;             ///< the row of each point; empty: all rows
};

/// Adds the classes to the module.
void addResults(pybind11::module_& module);

}  // namespace pcl_symmetry::python
