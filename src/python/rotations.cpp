#include "python/rotations.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "python/input_points.h"
#include "python/motions.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

ObjectSymmetries rotations(const AnyArray& points, ObjectSymmetryOptions options,
                           const std::optional<MeshSurface>& mesh) {
  const InputPoints input("points", points, 0, options.seed);
  const py::gil_scoped_release release;
  return mesh ? objectSymmetries(input.points(), *mesh, options) : objectSymmetries(input.points(), options);
}

void addClass(py::module_& module) {
  py::class_<ObjectSymmetries>(module, "Rotations", "The rotations that map a shape onto itself.")
      .def_property_readonly("name", &ObjectSymmetries::name, "after Schoenflies: C3, D4, T, O, I, Cinf, Dinf or SO3")
      .def_readonly("fold", &ObjectSymmetries::fold, "order of the main axis; 0 where it is one of revolution")
      .def_readonly("center", &ObjectSymmetries::center, "(3,) point that all axes pass through")
      .def_property_readonly(
          "discrete", [](const ObjectSymmetries& s) { return stacked(s.discrete); },
          "(K, 4, 4) motions of the input frame, without the identity")
      .def_property_readonly(
          "continuous",
          [](const ObjectSymmetries& s) {
            std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> axes;
            for (const ContinuousSymmetry& axis : s.continuous) axes.emplace_back(axis.offset, axis.axis);
            return axes;
          },
          "list of (point, direction) of axes of revolution")
      .def_readonly("support", &ObjectSymmetries::support, "share of the surface that is mapped onto the surface")
      .def_readonly("confidence", &ObjectSymmetries::confidence,
                    "probability that the whole surface, not its points alone, keeps to the limits")
      .def_readonly("tolerance", &ObjectSymmetries::tolerance, "that was decided at, input units")
      .def(
          "equivalents",
          [](const ObjectSymmetries& s, const RowMajor4& pose, double step) {
            return stacked(s.equivalents(motionOf("pose", pose), step));
          },
          py::arg("pose"), py::arg("step") = 0.5,
          "(K, 4, 4) the poses that look like one, it first. pose: (4, 4) from the input frame to any other, as that "
          "of a\n"
          "camera. step: radians between turns about an axis of revolution.")
      .def(
          "canonical",
          [](const ObjectSymmetries& s, const RowMajor4& pose) {
            return RowMajor4(s.canonical(motionOf("pose", pose)).matrix());
          },
          py::arg("pose"), "(4, 4) one pose for all that look the same: the one that is turned least.")
      .def(
          "closest_to",
          [](const ObjectSymmetries& s, const RowMajor4& pose, const RowMajor4& previous) {
            return RowMajor4(s.closestTo(motionOf("pose", pose), motionOf("previous", previous)).matrix());
          },
          py::arg("pose"), py::arg("previous"),
          "(4, 4) the pose that looks like the first and is turned least from the second: what continues a track.")
      .def(
          "mssd",
          [](const ObjectSymmetries& s, const RowMajor4& estimate, const RowMajor4& truth, const AnyArray& points) {
            const InputPoints input("points", points, 0, 0);
            return s.surfaceDistance(motionOf("estimate", estimate), motionOf("truth", truth), input.points());
          },
          py::arg("estimate"), py::arg("truth"), py::arg("points"),
          "Maximum surface distance of two poses under the symmetries (MSSD of the BOP benchmark), input units.\n"
          "points: (N, 3), such as the vertices of the model.");
}

}  // namespace

void addRotations(py::module_& module) {
  addClass(module);
  module.def(
      "rotations_of",
      [](const std::vector<RowMajor4>& discrete,
         const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& continuous) {
        std::vector<Eigen::Isometry3d> motions;
        for (const RowMajor4& motion : discrete) motions.push_back(motionOf("discrete", motion));
        std::vector<ContinuousSymmetry> axes;
        for (const auto& [point, direction] : continuous) axes.push_back({direction, point});
        return ObjectSymmetries::from(motions, axes);
      },
      py::arg("discrete"), py::arg("continuous"),
      "Rotations of given motions, (K, 4, 4), and (point, direction) of axes.");
  const ObjectSymmetryOptions standard;
  module.def(
      "rotations",
      [](const AnyArray& points, double tolerance, double absolute_tolerance, double max_feature, std::uint64_t seed,
         int threads, const std::optional<MeshSurface>& mesh) {
        ObjectSymmetryOptions options;
        options.tolerance = tolerance;
        options.absolute_tolerance = absolute_tolerance;
        options.max_feature = max_feature;
        options.seed = seed;
        options.num_threads = threads;
        return rotations(points, options, mesh);
      },
      py::arg("points"), py::kw_only(), py::arg("tolerance") = standard.tolerance, py::arg("absolute_tolerance") = 0.0,
      py::arg("max_feature") = standard.max_feature, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("mesh") = py::none(),
      "The group of rotations that map a whole object onto itself (Section 6). Returns Rotations.\n\n"
      "tolerance, absolute_tolerance: as in planes().\n"
      "max_feature: share of the surface, such as a screw or a notch, that a symmetry may map off it, in [0, 1].\n"
      "Raises ValueError for bad parameters, fewer than 20 distinct points, and points on a line.");
}

}  // namespace pcl_symmetry::python
