/// The evidence of decisions as structured arrays of NumPy: one row a candidate, named columns.
#pragma once

#include <pybind11/numpy.h>

#include "core/detection/detection_evidence.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry::python {

/// \return one row for each candidate of planes(evidence=True); empty without evidence.
pybind11::array planeEvidence(const DetectionEvidence& evidence);
/// \return one row for each turn of a scan; empty without evidence.
pybind11::array rotationEvidence(const DetectionEvidence& evidence);
/// \return one row for each of SymmetryFrame::probable.
pybind11::array frameEvidence(const SymmetryFrame& frame);

/// Adds the class Merging to the module.
void addEvidence(pybind11::module_& module);

}  // namespace pcl_symmetry::python
