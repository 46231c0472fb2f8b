/// What the Python module needs PCL for: poses refined by its ICP, and the database of models. Loaded when one of these
/// is asked for.
#include <pcl/exceptions.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/symmetry_database.h"
#include "pcl_symmetry/symmetry_registration.h"
#include "python/input_points.h"
#include "python/motions.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

using Cloud = SymmetryDatabase::Cloud;

CloudRegistration registerPoints(const AnyArray& source, const AnyArray& target, const RowMajor4& guess,
                                 const std::optional<std::pair<double, double>>& around,
                                 const py::object& source_viewpoint, const py::object& target_viewpoint,
                                 std::uint64_t seed, int threads) {
  const InputPoints source_input("source", source, 0, seed), target_input("target", target, 0, seed);
  const std::optional<Visibility> source_seen = seenFrom(source_input.points(), source_viewpoint);
  const std::optional<Visibility> target_seen = seenFrom(target_input.points(), target_viewpoint);
  const Eigen::Isometry3d T_target_source = motionOf("guess", guess);
  const py::gil_scoped_release release;
  CloudRegistrationOptions options;
  options.seed = seed;
  options.num_threads = threads;
  if (around) options.around = PoseNeighborhood{around->first, around->second};
  return registerClouds(source_input.points(), source_seen, target_input.points(), target_seen, T_target_source,
                        options);
}

Cloud cloudOf(const char* name, const py::array& points) {
  const InputPoints input(name, points, 0, 0);
  Cloud cloud;
  const PointsRef used = input.points();
  cloud.reserve(static_cast<std::size_t>(used.cols()));
  for (Eigen::Index i = 0; i < used.cols(); ++i) cloud.emplace_back(used(0, i), used(1, i), used(2, i));
  return cloud;
}

/// Models of a mapping from names to points, or of pairs of both. Points become clouds when they are used.
std::vector<ModelInput> modelsOf(const py::object& models) {
  const py::object pairs = py::hasattr(models, "items") ? models.attr("items")() : models;
  std::vector<ModelInput> inputs;
  for (const py::handle pair : pairs) {
    std::pair<std::string, py::object> model;
    try {
      model = pair.cast<decltype(model)>();
    } catch (const py::cast_error&) {
      throw py::type_error("models: item " + std::to_string(inputs.size()) + " is no pair of a name and points");
    }
    // Shared, as the threads that copy it do not hold the lock of the interpreter.
    const auto held = std::make_shared<py::object>(std::move(model.second));
    inputs.push_back({model.first, {}, [held] {
                        const py::gil_scoped_acquire acquire;
                        return cloudOf("points", arrayOf("points", *held));
                      }});
  }
  return inputs;
}

BuildReport build(SymmetryDatabase& database, const py::object& models, const py::object& progress) {
  const std::vector<ModelInput> inputs = modelsOf(models);
  BuildProgress told;
  if (!progress.is_none())
    told = [&progress](double share) {
      const py::gil_scoped_acquire acquire;
      const py::object go_on = progress(share);
      return go_on.is_none() || go_on.cast<bool>();
    };
  const py::gil_scoped_release release;
  return database.build(inputs, told);
}

std::size_t merge(SymmetryDatabase& database, const std::vector<std::filesystem::path>& files) {
  const std::vector<std::string> names(files.begin(), files.end());
  const py::gil_scoped_release release;
  return database.merge(names);
}

py::array_t<float> rowsOf(const Cloud& cloud) {
  py::array_t<float> rows({static_cast<py::ssize_t>(cloud.size()), py::ssize_t{3}});
  Eigen::Map<Points> columns(rows.mutable_data(), 3, static_cast<Eigen::Index>(cloud.size()));
  for (std::size_t i = 0; i < cloud.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = cloud[i].getVector3fMap();
  return rows;
}

Viewpoint viewpointOf(const py::object& viewpoint) {
  if (viewpoint.is_none()) return {Viewpoint::Mode::None, Eigen::Vector3d::Zero()};
  if (!py::isinstance<py::str>(viewpoint)) {
    try {
      return {Viewpoint::Mode::Given, viewpoint.cast<Eigen::Vector3d>()};
    } catch (const py::cast_error&) {
    }
  } else if (viewpoint.cast<std::string>() == "auto") {
    return {};
  }
  throw std::invalid_argument("viewpoint = " + py::str(viewpoint).cast<std::string>() +
                              ", must be \"auto\", None or (x, y, z)");
}

void addRegistration(py::module_& module) {
  py::class_<PoseScore>(module, "PoseScore", "What two clouds say about a pose.")
      .def_readonly("support", &PoseScore::support, "share of the source that lies on the target, in [0, 1]")
      .def_readonly("conflict", &PoseScore::conflict, "share of either that lies in space seen to be empty, in [0, 2]")
      .def_property_readonly("merit", &PoseScore::merit, "support - conflict / 2; a perfect pose has 1");
  py::class_<CloudRegistration>(module, "Registration", "The pose of one cloud relative to another.")
      .def_property_readonly(
          "transform", [](const CloudRegistration& r) { return RowMajor4(r.T_target_source.matrix()); },
          "(4, 4) from the frame of the source to that of the target")
      .def_property_readonly(
          "score", [](const CloudRegistration& r) { return r.score; }, "PoseScore of the transform")
      .def_readonly("on_surface", &CloudRegistration::on_surface)
      .def_property_readonly("converged", [](const CloudRegistration& r) { return r.converged(); })
      .def_property_readonly(
          "poses",
          [](const CloudRegistration& r) {
            std::vector<std::pair<RowMajor4, PoseScore>> poses;
            for (const RegisteredPose& pose : r.poses)
              poses.emplace_back(RowMajor4(pose.T_target_source.matrix()), pose.score);
            return poses;
          },
          "list of (transform, score), best first: poses that symmetry makes equal have like merits")
      .def_property_readonly(
          "covariance", [](const CloudRegistration& r) { return r.covariance; },
          "(6, 6) of the small turn, radians, and way, input units, by which noise and sampling put the pose off, "
          "frame\n"
          "of the target; None where no pose was found");
  module.def(
      "register", &registerPoints, py::arg("source"), py::arg("target"), py::kw_only(),
      py::arg("guess") = RowMajor4(RowMajor4::Identity()), py::arg("around") = py::none(),
      py::arg("source_viewpoint") = "auto", py::arg("target_viewpoint") = "auto", py::arg("seed") = 1,
      py::arg("threads") = 0,
      "The pose of a scan, or a whole object, relative to another cloud of it, from any start (Section 5.1).\n\n"
      "source, target: (N, 3) and (M, 3), same units. guess: (4, 4), tried beside many other poses.\n"
      "around: (radians, input units), how far the pose may be from the guess, for tracks; None: all poses.\n"
      "source_viewpoint, target_viewpoint: as in planes().\n"
      "Returns Registration; poses of a wrong object have a merit below 0.32, those of the right one 0.5 or more.");
}

void addResults(py::module_& module) {
  py::class_<ModelMatch>(module, "Match", "A model that is like a shape.")
      .def_readonly("name", &ModelMatch::name)
      .def_readonly("distance", &ModelMatch::distance, "1 between shapes as far apart as from what is most like them");
  py::class_<RecognizedModel>(module, "Recognized", "A model that a scan shows.")
      .def_readonly("name", &RecognizedModel::name)
      .def_readonly("score", &RecognizedModel::score, "PoseScore")
      .def_readonly("confidence", &RecognizedModel::confidence, "probability that the scan shows this model")
      .def_property_readonly(
          "transform", [](const RecognizedModel& m) { return RowMajor4(m.T_model_scan.matrix()); },
          "(4, 4) from the frame of the scan to that of the model");
  py::class_<BuildReport>(module, "BuildReport", "What Database.build() did.")
      .def_readonly("num_added", &BuildReport::num_added, "models that were stored")
      .def_readonly("num_kept", &BuildReport::num_kept)
      .def_readonly("failures", &BuildReport::failures, "list of (name, reason), in the order of the models")
      .def_readonly("cancelled", &BuildReport::cancelled, "the progress function returned False");
}

void addDatabase(py::module_& module) {
  py::class_<SymmetryDatabase>(module, "Database", "Models in one file, found by shape (Section 5.2).")
      .def(py::init([](const std::string& file, const std::string& unit, int threads) {
             DatabaseOptions options;
             options.unit = unit;
             options.num_threads = threads;
             return std::make_unique<SymmetryDatabase>(file, options);
           }),
           py::arg("file"), py::kw_only(), py::arg("unit") = "", py::arg("threads") = 0,
           "Opens the file, or makes it. Raises OSError where it is no database that can be used.")
      .def_property_readonly("names", &SymmetryDatabase::names, "names of all models, sorted")
      .def("__len__", &SymmetryDatabase::size)
      .def("__contains__", &SymmetryDatabase::contains)
      .def(
          "add",
          [](SymmetryDatabase& database, const std::string& name, const AnyArray& points) {
            const Cloud cloud = cloudOf("points", points);
            const py::gil_scoped_release release;
            database.add(name, cloud);
          },
          py::arg("name"), py::arg("points"), "Stores a model, (N, 3) points all around it; on the disk on return.")
      .def("build", &build, py::arg("models"), py::kw_only(), py::arg("progress") = py::none(),
           "Stores many models, each as soon as it is described, on all threads.\n\n"
           "models: dict of name to (N, 3) points, or pairs of both. progress: called with the share done, in [0, 1];\n"
           "where it returns False the rest is left. Returns BuildReport; a model that cannot be used does not stop\n"
           "the others.")
      .def("merge", &merge, py::arg("files"),
           "Adds all models of other databases, such as parts that several machines built; all of them or none.\n\n"
           "Returns their number. Raises OSError, naming file and reason, where one is missing, damaged or of another\n"
           "version or unit, or two have a model of the same name; nothing is changed then.")
      .def("remove", &SymmetryDatabase::remove, py::arg("name"))
      .def(
          "cloud",
          [](const SymmetryDatabase& database, const std::string& name) { return rowsOf(database.cloud(name)); },
          py::arg("name"), "(N, 3) points of a model")
      .def(
          "match",
          [](const SymmetryDatabase& database, const AnyArray& points, int num_nearest, const py::object& viewpoint) {
            const Cloud cloud = cloudOf("points", points);
            const Viewpoint from = viewpointOf(viewpoint);
            const py::gil_scoped_release release;
            return database.match(cloud, num_nearest, from);
          },
          py::arg("points"), py::arg("num_nearest") = 10, py::kw_only(), py::arg("viewpoint") = "auto",
          "The models most like a cloud, in any pose and size: list of Match, nearest first.")
      .def(
          "recognize",
          [](const SymmetryDatabase& database, const AnyArray& points, const py::object& viewpoint,
             double min_confidence, int threads) {
            const Cloud cloud = cloudOf("points", points);
            const Viewpoint from = viewpointOf(viewpoint);
            RecognitionOptions options;
            options.min_confidence = min_confidence;
            options.num_threads = threads;
            const py::gil_scoped_release release;
            return database.recognize(cloud, options, from);
          },
          py::arg("points"), py::kw_only(), py::arg("viewpoint") = "auto",
          py::arg("min_confidence") = RecognitionOptions().min_confidence, py::arg("threads") = 0,
          "The model that a scan shows, in its own size: list of Recognized, best first; empty for an unknown "
          "object.\n\n"
          "min_confidence: least probability of a model that is accepted, in [0, 1].");
}

}  // namespace

PYBIND11_MODULE(_recognition, module) {
  // Messages of the library name the file or the parameter.
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const pcl::IOException& exception) {
      PyErr_SetString(PyExc_OSError, exception.what());
    } catch (const pcl::PCLException& exception) {
      PyErr_SetString(PyExc_ValueError, exception.what());
    }
  });
  addRegistration(module);
  addResults(module);
  addDatabase(module);
}

}  // namespace pcl_symmetry::python
