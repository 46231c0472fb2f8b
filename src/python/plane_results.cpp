#include "python/plane_results.h"

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <vector>

#include "pcl_symmetry/core/viewpoint_score.h"
#include "python/evidence.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

const char* nameOf(PlaneKind kind) {
  static const char* const names[] = {"symmetry", "possible", "approximate", "local"};
  return names[static_cast<int>(kind)];
}

void addPlane(py::module_& module) {
  py::class_<ReflectionPlane>(module, "ReflectionPlane", "A plane of reflection: normal . x = offset.")
      .def(py::init<const Eigen::Vector3d&, double>(), py::arg("normal"), py::arg("offset"),
           "normal: (3,), finite, not zero; it is normalized, and the offset divided by its length.")
      .def_property_readonly(
          "normal", [](const ReflectionPlane& p) { return Eigen::Vector3d(p.normal()); }, "(3,) unit")
      .def_property_readonly("offset", &ReflectionPlane::offset, "normal . x of points x in the plane, input units")
      .def_property_readonly("coefficients", &ReflectionPlane::coefficients,
                             "(4,) a, b, c, d of a x + b y + c z + d = 0")
      .def_property_readonly(
          "reflection", [](const ReflectionPlane& p) { return Eigen::Matrix4d(p.reflection().matrix()); },
          "(4, 4) the reflection, x -> R x")
      .def(
          "distance", [](const ReflectionPlane& p, const Eigen::Vector3d& x) { return p.signedDistance(x); },
          py::arg("x"), "signed distance of a point, input units")
      .def("angle_to", &ReflectionPlane::angleTo, py::arg("other"), "angle between two planes, in [0, pi/2] radians");
  py::class_<SymmetryPlane, ReflectionPlane>(module, "Plane", "A local maximum of the transform, refined and judged.")
      .def_property_readonly(
          "kind", [](const SymmetryPlane& p) { return nameOf(p.kind); }, "symmetry, possible, approximate or local")
      .def_readonly("confidence", &SymmetryPlane::confidence, "probability that it is a symmetry, in [0, 1]")
      .def_readonly("score", &SymmetryPlane::score, "D of equation 2, in [0, 1]")
      .def_readonly("support", &SymmetryPlane::support, "share of the surface seen that is mapped onto it, in [0, 1]")
      .def_readonly("share", &SymmetryPlane::share, "estimated share mapped to within the tolerance, in [0, 1]")
      .def_property_readonly(
          "share_interval", [](const SymmetryPlane& p) { return std::make_pair(p.share_low, p.share_high); },
          "limits of that share for the whole object, 95 of 100 cases")
      .def_readonly("deviation", &SymmetryPlane::deviation,
                    "97 % of the reflected points stay within this distance of the surface, input units")
      .def_readonly("seen", &SymmetryPlane::seen, "share of the points whose reflection the cloud could show")
      .def_readonly("residual", &SymmetryPlane::residual, "root mean square distance of reflected points, input units");
}

template <typename Symmetry>
void addScores(py::class_<Symmetry>& type) {
  type.def_readonly("point", &Symmetry::point, "(3,) input frame")
      .def_readonly("confidence", &Symmetry::confidence, "as that of Plane")
      .def_readonly("score", &Symmetry::score, "as that of Plane")
      .def_readonly("support", &Symmetry::support, "as that of Plane");
}

void addEvidenceOfSearch(py::class_<PlaneSearch>& type) {
  type.def_property_readonly("evidence", [](const PlaneSearch& s) { return planeEvidence(s.found); })
      .def_property_readonly("turn_evidence", [](const PlaneSearch& s) { return turnEvidence(s.found); });
}

}  // namespace

void addPlaneResults(py::module_& module) {
  addPlane(module);
  py::class_<SymmetryAxis> axis(module, "Axis", "All planes through a line are symmetries: a body of revolution.");
  addScores(axis);
  axis.def_readonly("direction", &SymmetryAxis::direction, "(3,) unit");
  py::class_<SymmetryTurn>(module, "Turn", "Turns about a line map what a scanner saw onto itself or to unseen places.")
      .def_readonly("point", &SymmetryTurn::point, "(3,) input frame")
      .def_readonly("direction", &SymmetryTurn::direction, "(3,) unit")
      .def_readonly("fold", &SymmetryTurn::fold, "order of the turns; 0: by any angle")
      .def_readonly("confidence", &SymmetryTurn::confidence,
                    "probability that these turns are symmetries of the whole object")
      .def_readonly("support", &SymmetryTurn::support, "share of the points that the best turn maps onto the surface")
      .def_readonly("off", &SymmetryTurn::off, "share that the worst turn maps to where the scanner saw nothing");
  py::class_<SymmetryCenter> center(module, "Center", "All planes through a point are symmetries: a sphere.");
  addScores(center);
  py::class_<RankedView>(module, "View", "A direction to look at an object from.")
      .def_readonly("direction", &RankedView::direction, "(3,) unit, from the object to the camera")
      .def_readonly("score", &RankedView::score, "S of Section 5.4, >= 0");
  py::class_<PlaneSearch> search(module, "Planes", "What planes() found; behaves as the list of its planes.");
  addEvidenceOfSearch(search);
  search
      .def_property_readonly(
          "planes", [](const PlaneSearch& s) { return s.found.planes; },
          "list of Plane: symmetries, possible, approximate, local; each best first")
      .def_property_readonly(
          "axes", [](const PlaneSearch& s) { return s.found.axes; }, "list of Axis, best first")
      .def_property_readonly(
          "centers", [](const PlaneSearch& s) { return s.found.centers; }, "list of Center")
      .def_property_readonly(
          "turns", [](const PlaneSearch& s) { return s.found.turns; },
          "list of Turn, of scans from one side, best first")
      .def_property_readonly(
          "best", [](const PlaneSearch& s) { return s.found.best; },
          "where there is no symmetry and no possible one: the plane that comes closest; else None")
      .def_property_readonly(
          "flat",
          [](const PlaneSearch& s) -> std::optional<Eigen::Vector4d> {
            if (!s.found.flat) return std::nullopt;
            return s.found.flat->coefficients();
          },
          "(4,) plane that all points of a sheet or a disc lie near; None: the cloud is not flat")
      .def_property_readonly(
          "tolerance", [](const PlaneSearch& s) { return s.found.tolerance; }, "that was decided at, input units")
      .def_property_readonly(
          "reason", [](const PlaneSearch& s) { return s.found.reason; },
          "why there is no answer; empty where the search ran")
      .def_readonly("viewpoint", &PlaneSearch::viewpoint, "(3,) where the scanner stood; None: seen from all sides")
      .def_property_readonly("support",
                             [](const PlaneSearch& s) {
                               std::vector<py::array_t<float>> supports;
                               for (const SymmetryPlane& plane : s.found.planes)
                                 supports.emplace_back(static_cast<py::ssize_t>(plane.point_support.size()),
                                                       plane.point_support.data());
                               return supports;
                             })
      .def_property_readonly("rows", [](const PlaneSearch& s) {
        return py::array_t<std::size_t>(static_cast<py::ssize_t>(s.rows.size()), s.rows.data());
      });
}

}  // namespace pcl_symmetry::python
