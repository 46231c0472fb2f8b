#include "python/results.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <utility>

#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/symmetrized_shape.h"
#include "pcl_symmetry/core/symmetry_map.h"
#include "python/evidence.h"
#include "python/input_points.h"
#include "python/motions.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

void addPlanes(py::module_& module) {
  py::class_<ReflectionPlane>(module, "ReflectionPlane")
      .def(py::init<const Eigen::Vector3d&, double>())
      .def_property_readonly("normal", [](const ReflectionPlane& p) { return Eigen::Vector3d(p.normal()); })
      .def_property_readonly("offset", &ReflectionPlane::offset);
  py::class_<SymmetryPlane, ReflectionPlane>(module, "Plane")
      .def_property_readonly("kind", [](const SymmetryPlane& p) { return toString(p.kind); })
      .def_property_readonly("share_interval",
                             [](const SymmetryPlane& p) { return std::pair(p.share_low, p.share_high); })
      .def_property_readonly("reasons",
                             [](const SymmetryPlane& p) {
                               py::tuple reasons(p.reasons.size());
                               for (std::size_t i = 0; i < p.reasons.size(); ++i)
                                 reasons[i] = py::make_tuple(p.reasons[i].rule, p.reasons[i].odds);
                               return reasons;
                             })
      .def_readonly("confidence", &SymmetryPlane::confidence)
      .def_readonly("score", &SymmetryPlane::score)
      .def_readonly("support", &SymmetryPlane::support)
      .def_readonly("share", &SymmetryPlane::share)
      .def_readonly("deviation", &SymmetryPlane::deviation)
      .def_readonly("seen", &SymmetryPlane::seen)
      .def_readonly("residual", &SymmetryPlane::residual)
      .def_readonly("iterations", &SymmetryPlane::iterations)
      .def_readonly("converged", &SymmetryPlane::converged);
  py::class_<SymmetryAxis>(module, "Axis")
      .def_readonly("point", &SymmetryAxis::point)
      .def_readonly("direction", &SymmetryAxis::direction)
      .def_readonly("confidence", &SymmetryAxis::confidence)
      .def_readonly("score", &SymmetryAxis::score)
      .def_readonly("support", &SymmetryAxis::support);
  py::class_<SymmetryCenter>(module, "Center")
      .def_readonly("point", &SymmetryCenter::point)
      .def_readonly("confidence", &SymmetryCenter::confidence)
      .def_readonly("score", &SymmetryCenter::score)
      .def_readonly("support", &SymmetryCenter::support);
  py::class_<SymmetryRotation>(module, "RotationAxis")
      .def_readonly("point", &SymmetryRotation::point)
      .def_readonly("direction", &SymmetryRotation::direction)
      .def_readonly("fold", &SymmetryRotation::fold)
      .def_readonly("confidence", &SymmetryRotation::confidence)
      .def_readonly("support", &SymmetryRotation::support)
      .def_readonly("off", &SymmetryRotation::off)
      .def_readonly("far", &SymmetryRotation::far)
      .def_readonly("halfway", &SymmetryRotation::halfway);
}

void addPlaneSearch(py::module_& module) {
  py::class_<PlaneSearch>(module, "Planes")
      .def_property_readonly("planes", [](const PlaneSearch& s) { return s.found.planes; })
      .def_property_readonly("axes", [](const PlaneSearch& s) { return s.found.axes; })
      .def_property_readonly("centers", [](const PlaneSearch& s) { return s.found.centers; })
      .def_property_readonly("rotations", [](const PlaneSearch& s) { return s.found.rotations; })
      .def_property_readonly("best", [](const PlaneSearch& s) { return s.found.best; })
      .def_property_readonly("flat",
                             [](const PlaneSearch& s) {
                               std::optional<Eigen::Vector4d> plane;
                               if (s.found.flat) plane = s.found.flat->coefficients();
                               return plane;
                             })
      .def_property_readonly("tolerance", [](const PlaneSearch& s) { return s.found.tolerance; })
      .def_property_readonly("resolution", [](const PlaneSearch& s) { return s.found.resolution; })
      .def_property_readonly("diameter", [](const PlaneSearch& s) { return s.found.diameter; })
      .def_property_readonly("stray_points", [](const PlaneSearch& s) { return s.found.num_stray_points; })
      .def_property_readonly("reason", [](const PlaneSearch& s) { return s.found.reason; })
      .def_readonly("viewpoint", &PlaneSearch::viewpoint)
      .def_property_readonly("support",
                             [](const PlaneSearch& s) {
                               std::vector<py::array_t<float>> supports;
                               for (const SymmetryPlane& plane : s.found.planes)
                                 supports.push_back(toArray(plane.point_support));
                               return supports;
                             })
      .def_property_readonly("maxima",
                             [](const PlaneSearch& s) {
                               std::vector<std::pair<Eigen::Vector3d, double>> maxima;
                               for (const LocalMaximum& maximum : findLocalMaxima(s.found.map, {}, 1))
                                 maxima.emplace_back(maximum.plane.normal(), maximum.value);
                               return maxima;
                             })
      .def_property_readonly("rows", [](const PlaneSearch& s) { return toArray(s.rows); })
      .def_property_readonly("evidence", [](const PlaneSearch& s) { return planeEvidence(s.evidence); })
      .def_property_readonly("rotation_evidence", [](const PlaneSearch& s) { return rotationEvidence(s.evidence); });
}

void addFrame(py::module_& module) {
  py::class_<ProbableFrame>(module, "ProbableFrame")
      .def_readonly("center", &ProbableFrame::center)
      .def_readonly("axes", &ProbableFrame::axes)
      .def_readonly("revolution_axis", &ProbableFrame::revolution_axis)
      .def_readonly("probability", &ProbableFrame::probability);
  py::class_<SymmetryFrame>(module, "Frame")
      .def_readonly("center", &SymmetryFrame::center)
      .def_readonly("axes", &SymmetryFrame::axes)
      .def_readonly("scores", &SymmetryFrame::scores)
      .def_readonly("revolution_axis", &SymmetryFrame::revolution_axis)
      .def_property_readonly("transform",
                             [](const SymmetryFrame& f) { return RowMajor4(f.T_canonical_input.matrix()); })
      .def_property_readonly("equivalent", [](const SymmetryFrame& f) { return stacked(f.equivalent); })
      .def_readonly("rotations", &SymmetryFrame::rotations)
      .def_readonly("stray_points", &SymmetryFrame::num_stray_points)
      .def_readonly("probable", &SymmetryFrame::probable)
      .def_property_readonly("evidence", &frameEvidence);
}

void addRotations(py::module_& module) {
  py::class_<ObjectSymmetries>(module, "Rotations")
      .def_property_readonly("name", &ObjectSymmetries::name)
      .def_readonly("fold", &ObjectSymmetries::fold)
      .def_readonly("center", &ObjectSymmetries::center)
      .def_property_readonly("discrete", [](const ObjectSymmetries& s) { return stacked(s.discrete); })
      .def_property_readonly("continuous",
                             [](const ObjectSymmetries& s) {
                               std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> axes;
                               for (const ContinuousSymmetry& axis : s.continuous)
                                 axes.emplace_back(axis.offset, axis.axis);
                               return axes;
                             })
      .def_readonly("support", &ObjectSymmetries::support)
      .def_readonly("confidence", &ObjectSymmetries::confidence)
      .def_readonly("tolerance", &ObjectSymmetries::tolerance)
      .def_readonly("stray_points", &ObjectSymmetries::num_stray_points)
      .def_readonly("reason", &ObjectSymmetries::reason)
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
}

}  // namespace

void addResults(py::module_& module) {
  addPlanes(module);
  addPlaneSearch(module);
  addFrame(module);
  addRotations(module);
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
  py::class_<SymmetrizedShape>(module, "Symmetrized")
      .def_property_readonly("points", [](const SymmetrizedShape& s) { return toRows(s.points); })
      .def_readonly("kept", &SymmetrizedShape::kept)
      .def_property_readonly("asymmetry", [](const SymmetrizedShape& s) { return toArray(s.asymmetry); })
      .def_readonly("mean_asymmetry", &SymmetrizedShape::mean_asymmetry)
      .def_readonly("greatest_asymmetry", &SymmetrizedShape::greatest_asymmetry)
      .def_readonly("deviation", &SymmetrizedShape::deviation);
}

}  // namespace pcl_symmetry::python
