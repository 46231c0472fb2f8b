/// Rotations of objects in the Python module.
#pragma once

#include <pybind11/pybind11.h>

namespace pcl_symmetry::python {

/// Adds rotations() and the class Rotations to the module.
void addRotations(pybind11::module_& module);

}  // namespace pcl_symmetry::python
