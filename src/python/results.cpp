#include "python/results.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <utility>

#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/symmetry_map.h"
#include "python/input_points.h"
#include "python/motions.h"

namespace py = pybind11;
using py::literals::operator""_a;

namespace pcl_symmetry {

py::dict dictOf(const SymmetryPlane& p) {
  py::list reasons;
  for (const Reason& reason : p.reasons) reasons.append(py::make_tuple(reason.rule, reason.odds));
  return py::dict("normal"_a = p.normal(), "offset"_a = p.offset(), "kind"_a = toString(p.kind),
                  "confidence"_a = p.confidence, "reasons"_a = py::tuple(reasons), "share"_a = p.share,
                  "share_interval"_a = std::pair(p.share_low, p.share_high), "score"_a = p.score,
                  "support"_a = p.support, "deviation"_a = p.deviation, "seen"_a = p.seen, "residual"_a = p.residual,
                  "iterations"_a = p.iterations, "converged"_a = p.converged);
}

py::dict dictOf(const SymmetryAxis& a) {
  return py::dict("point"_a = a.point, "direction"_a = a.direction, "confidence"_a = a.confidence, "score"_a = a.score,
                  "support"_a = a.support);
}

py::dict dictOf(const SymmetryCenter& c) {
  return py::dict("point"_a = c.point, "confidence"_a = c.confidence, "score"_a = c.score, "support"_a = c.support);
}

py::dict dictOf(const SymmetryRotation& r) {
  return py::dict("point"_a = r.point, "direction"_a = r.direction, "fold"_a = r.fold, "confidence"_a = r.confidence,
                  "support"_a = r.support, "off"_a = r.off, "far"_a = r.far, "halfway"_a = r.halfway);
}

py::dict dictOf(const ProbableFrame& f) {
  return py::dict("center"_a = f.center, "axes"_a = f.axes, "revolution_axis"_a = f.revolution_axis,
                  "probability"_a = f.probability);
}

py::dict dictOf(const SymmetryFrame& f) {
  return py::dict(
      "center"_a = f.center, "axes"_a = f.axes, "scores"_a = f.scores, "revolution_axis"_a = f.revolution_axis,
      "transform"_a = python::RowMajor4(f.T_canonical_input.matrix()), "equivalent"_a = python::stacked(f.equivalent),
      "rotations"_a = f.rotations, "stray_points"_a = f.num_stray_points, "probable"_a = f.probable,
      "evidence"_a = python::frameEvidence(f));
}

py::dict dictOf(const SymmetrizedShape& s) {
  return py::dict("points"_a = python::toRows(s.points), "kept"_a = s.kept,
                  "asymmetry"_a = python::toArray(s.asymmetry), "mean_asymmetry"_a = s.mean_asymmetry,
                  "greatest_asymmetry"_a = s.greatest_asymmetry, "deviation"_a = s.deviation);
}

namespace python {

py::dict dictOf(const PlaneSearch& search) {
  const Detection& found = search.found;
  std::vector<py::array_t<float>> supports;
  for (const SymmetryPlane& plane : found.planes) supports.push_back(toArray(plane.point_support));
  std::vector<std::pair<Eigen::Vector3d, double>> maxima;
  for (const LocalMaximum& maximum : findLocalMaxima(found.map, {}, 1))
    maxima.emplace_back(maximum.plane.normal(), maximum.value);
  std::optional<Eigen::Vector4d> flat;
  if (found.flat) flat = found.flat->coefficients();
  return py::dict("planes"_a = found.planes, "axes"_a = found.axes, "centers"_a = found.centers,
                  "rotations"_a = found.rotations, "best"_a = found.best, "undecided"_a = found.undecided,
                  "flat"_a = flat, "tolerance"_a = found.tolerance, "resolution"_a = found.resolution,
                  "diameter"_a = found.diameter, "stray_points"_a = found.num_stray_points, "reason"_a = found.reason,
                  "viewpoint"_a = search.viewpoint, "evidence"_a = planeEvidence(search.evidence),
                  "rotation_evidence"_a = rotationEvidence(search.evidence), "_support"_a = supports,
                  "_maxima"_a = maxima, "_rows"_a = toArray(search.rows));
}

namespace {

py::dict fieldsOf(const ObjectSymmetries& s) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> axes;
  for (const ContinuousSymmetry& axis : s.continuous) axes.emplace_back(axis.offset, axis.axis);
  return py::dict("name"_a = s.reason.empty() ? s.name() : "", "fold"_a = s.fold, "center"_a = s.center,
                  "discrete"_a = stacked(s.discrete), "continuous"_a = axes, "support"_a = s.support,
                  "confidence"_a = s.confidence, "tolerance"_a = s.tolerance, "stray_points"_a = s.num_stray_points,
                  "reason"_a = s.reason);
}

}  // namespace

void addResults(py::module_& module) {
  py::class_<ReflectionPlane>(module, "ReflectionPlane")
      .def(py::init<const Eigen::Vector3d&, double>())
      .def_property_readonly("normal", [](const ReflectionPlane& p) { return Eigen::Vector3d(p.normal()); })
      .def_property_readonly("offset", &ReflectionPlane::offset);
  py::class_<ObjectSymmetries>(module, "Rotations")
      .def_property_readonly("fields", &fieldsOf)
      .def(
          "equivalents",
          [](const ObjectSymmetries& s, const RowMajor4& pose, double step) {
            return stacked(s.equivalents(motionOf("pose", pose), step));
          },
          py::arg("pose"), py::arg("step"))
      .def(
          "canonical",
          [](const ObjectSymmetries& s, const RowMajor4& pose) {
            return RowMajor4(s.canonical(motionOf("pose", pose)).matrix());
          },
          py::arg("pose"))
      .def(
          "closest_to",
          [](const ObjectSymmetries& s, const RowMajor4& pose, const RowMajor4& previous) {
            return RowMajor4(s.closestTo(motionOf("pose", pose), motionOf("previous", previous)).matrix());
          },
          py::arg("pose"), py::arg("previous"))
      .def(
          "mssd",
          [](const ObjectSymmetries& s, const RowMajor4& estimate, const RowMajor4& truth, const AnyArray& points) {
            const InputPoints input("points", points, 0, 0);
            return s.surfaceDistance(motionOf("estimate", estimate), motionOf("truth", truth), input.points());
          },
          py::arg("estimate"), py::arg("truth"), py::arg("points"));
  py::class_<SymmetryMap>(module, "Map")
      .def_property_readonly(
          "values",
          [](const py::object& self) {  // a view of the map's memory
            const auto& map = self.cast<const SymmetryMap&>();
            const std::vector<py::ssize_t> shape{map.grid.numTheta(), map.grid.numPhi(), map.grid.numRadius()};
            return py::array_t<float>(shape, map.values.data(), self);
          })
      .def_property_readonly("center", [](const SymmetryMap& map) { return map.grid.center(); })
      .def_property_readonly("radius", [](const SymmetryMap& map) { return map.grid.radius(); })
      .def_readonly("sigma", &SymmetryMap::sigma);
}

}  // namespace python
}  // namespace pcl_symmetry
