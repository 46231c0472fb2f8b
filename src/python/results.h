/// Results of the core for the package. A plain one becomes a dict with the fields of the package's data class.
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/detection/plane_search.h"
#include "pcl_symmetry/core/symmetrized_shape.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

pybind11::dict dictOf(const SymmetryPlane& plane);
pybind11::dict dictOf(const SymmetryAxis& axis);
pybind11::dict dictOf(const SymmetryCenter& center);
pybind11::dict dictOf(const SymmetryRotation& rotation);
pybind11::dict dictOf(const ProbableFrame& frame);
pybind11::dict dictOf(const SymmetryFrame& frame);
pybind11::dict dictOf(const SymmetrizedShape& shape);

namespace python {

/// A detection, and the rows of the array that its points come from.
struct PlaneSearch {
  Detection found;
  DetectionEvidence evidence;                ///< empty if it was not requested
  std::optional<Eigen::Vector3d> viewpoint;  ///< viewpoint used, frame of the points
  std::vector<std::size_t> rows;             ///< the row of each point; empty: all rows
};
pybind11::dict dictOf(const PlaneSearch& search);

// The evidence of decisions as structured arrays: one row per candidate, named columns.
/// \return one row for each candidate of planes(evidence=True); empty without evidence.
pybind11::array planeEvidence(const DetectionEvidence& evidence);
/// \return one row for each rotation of a scan; empty without evidence.
pybind11::array rotationEvidence(const DetectionEvidence& evidence);
/// \return one row for each of SymmetryFrame::probable.
pybind11::array frameEvidence(const SymmetryFrame& frame);

/// Adds the classes of results with methods to the module.
void addResults(pybind11::module_& module);
/// Adds the class Merging.
void addEvidence(pybind11::module_& module);

}  // namespace python
}  // namespace pcl_symmetry

/// Any type with a dictOf() in its namespace.
template <typename Result>
struct pybind11::detail::type_caster<Result, std::void_t<decltype(dictOf(std::declval<const Result&>()))>> {
  static constexpr auto name = const_name("dict");
  static handle cast(const Result& result, return_value_policy, handle) { return dictOf(result).release(); }
};
