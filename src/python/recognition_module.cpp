/// The functions of the Python module that need PCL: poses refined by its ICP, and the database of models. Loaded on
/// first use.
#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "command_line/tool_errors.h"
#include "io/file_text.h"
#include "io/shape_readers.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"
#include "pcl_symmetry/register_all.h"
#include "pcl_symmetry/symmetry_database.h"
#include "pcl_symmetry/symmetry_registration.h"
#include "pcl_symmetry/symmetry_scene.h"
#include "pcl_symmetry/viewpoint_selection.h"
#include "python/computing.h"
#include "python/input_points.h"
#include "python/motions.h"
#include "python/results.h"

namespace py = pybind11;
using py::literals::operator""_a;

namespace pcl_symmetry {

static py::dict dictOf(const PoseScore& s) {
  return py::dict("support"_a = s.support, "conflict"_a = s.conflict, "merit"_a = s.merit());
}

static py::dict dictOf(const PoseEvidence& e) {
  return py::dict("overlap_source"_a = e.overlap_source, "overlap_target"_a = e.overlap_target,
                  "agreement"_a = e.agreement, "on_surface"_a = e.on_surface, "contradicted"_a = e.contradicted,
                  "missing"_a = e.missing, "aside"_a = e.aside, "outside"_a = e.outside, "noise"_a = e.noise,
                  "size_ratio"_a = e.size_ratio, "uniqueness"_a = e.uniqueness);
}

static py::dict dictOf(const CloudRegistration& r) {
  std::vector<std::pair<python::RowMajor4, PoseScore>> poses;
  for (const RegisteredPose& pose : r.poses) poses.emplace_back(pose.T_target_source.matrix(), pose.score);
  return py::dict("transform"_a = python::RowMajor4(r.T_target_source.matrix()), "score"_a = r.score,
                  "confidence"_a = r.confidence, "evidence"_a = r.evidence,
                  "reason"_a = r.converged() ? std::string() : r.doubt(), "converged"_a = r.converged(),
                  "poses"_a = poses, "covariance"_a = r.covariance);
}

static py::dict dictOf(const RegisteredScans& r) {
  std::vector<std::optional<python::RowMajor4>> transforms;
  std::vector<double> confidences;
  std::map<std::size_t, std::string> left_out;
  std::vector<std::tuple<int, int, double, bool>> pairs;
  for (const ScanPose& scan : r.scans) {
    if (!scan.left_out.empty()) left_out[transforms.size()] = scan.left_out;
    transforms.emplace_back();
    if (scan.left_out.empty()) transforms.back() = scan.T_first_scan.matrix();
    confidences.push_back(scan.left_out.empty() ? scan.confidence : 0.0);
  }
  for (const ScanPair& pair : r.pairs) pairs.emplace_back(pair.source, pair.target, pair.overlap, pair.used);
  return py::dict("transforms"_a = transforms, "confidences"_a = confidences, "left_out"_a = left_out,
                  "pairs"_a = pairs, "resolution"_a = r.resolution);
}

static py::dict dictOf(const ModelMatch& m) {
  return py::dict("name"_a = m.name, "distance"_a = m.distance);
}

static py::dict dictOf(const ModelEvidence& e) {
  return py::dict("on_model"_a = e.on_model, "shown"_a = e.shown);
}

static py::dict dictOf(const RecognizedModel& m) {
  return py::dict("name"_a = m.name, "confidence"_a = m.confidence,
                  "transform"_a = python::RowMajor4(m.T_model_scan.matrix()), "score"_a = m.score,
                  "evidence"_a = m.evidence);
}

static py::dict dictOf(const BuildReport& r) {
  return py::dict("num_added"_a = r.num_added, "num_kept"_a = r.num_kept, "failures"_a = r.failures,
                  "cancelled"_a = r.cancelled);
}

namespace python {

namespace {

using Cloud = SymmetryDatabase::Cloud;

/// \param points (N, 3), without rows that are not finite, or (H, W, 3) as given: rows and columns of a camera.
/// \param viewpoint if it is the viewpoint of a file, it becomes the sensor origin of the cloud; unused otherwise.
Cloud cloudOf(const py::array& points, const py::object& viewpoint = py::none(), const char* name = "points") {
  const bool is_organized = points.ndim() == 3;
  const InputPoints input(name, is_organized ? py::array(points.attr("reshape")(-1, points.shape(2))) : points, 0, 0);
  Cloud cloud;
  if (py::isinstance<StoredViewpoint>(viewpoint))
    cloud.sensor_origin_.head<3>() = viewpoint.cast<StoredViewpoint>().position.cast<float>();
  if (is_organized) {
    const py::array_t<float, py::array::c_style | py::array::forcecast> rows(points);
    cloud.resize(static_cast<std::uint32_t>(points.shape(1)), static_cast<std::uint32_t>(points.shape(0)));
    for (std::size_t i = 0; i < cloud.size(); ++i)
      cloud[i].getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(rows.data() + 3 * i);
    cloud.is_dense = false;
    return cloud;
  }
  const PointsRef used = input.points();
  cloud.reserve(used.cols());
  for (Eigen::Index i = 0; i < used.cols(); ++i) cloud.emplace_back(used(0, i), used(1, i), used(2, i));
  return cloud;
}

Viewpoint viewpointOf(const py::object& viewpoint) {
  if (viewpoint.is_none()) return {Viewpoint::Mode::None, Eigen::Vector3d::Zero()};
  const std::optional<Eigen::Vector3d> position = positionOf(viewpoint);
  return position ? Viewpoint{Viewpoint::Mode::Given, *position} : Viewpoint{};
}

/// What SymmetryRegistration uses of a cloud.
struct RegisteredCloud {
  Points points;
  std::optional<Visibility> seen;
  std::string reason;  ///< why there is no answer

  RegisteredCloud(const char* name, const py::array& array, const py::object& viewpoint, std::uint64_t seed) {
    const Cloud cloud = cloudOf(array, viewpoint, name);
    const Viewpoint from = viewpointOf(viewpoint);
    points = detail::selectPoints(cloud, nullptr, kRegistrationPoints, seed).points;
    reason = detail::reasonForNoAnswer(points, name, kLeastRegistrationPoints);
    const Computing computing;
    if (reason.empty()) seen = detail::visibilityOf(detail::findSeenSpace(cloud, points, from));
  }
};

CloudRegistration registerPoints(const AnyArray& source, const AnyArray& target, const RowMajor4& guess,
                                 const std::optional<std::pair<double, double>>& around,
                                 const py::object& source_viewpoint, const py::object& target_viewpoint,
                                 std::uint64_t seed, int threads) {
  const Eigen::Isometry3d T_target_source = motionOf("guess", guess);
  auto options = optionsWith<CloudRegistrationOptions>(seed, threads);
  if (around) options.around = PoseNeighborhood{around->first, around->second};
  options.validate();
  const RegisteredCloud from("source", source, source_viewpoint, seed), to("target", target, target_viewpoint, seed);
  for (const RegisteredCloud* cloud : {&from, &to})
    if (!cloud->reason.empty()) throw NoAnswer(cloud->reason);
  const Computing computing;
  return registerClouds(from.points, from.seen, to.points, to.seen, T_target_source, options);
}

/// The scans in one frame, and the rows of their merged points, as pairs (scan, row).
std::pair<RegisteredScans, py::array_t<int>> registerAllPoints(const std::vector<AnyArray>& clouds,
                                                               const std::vector<py::object>& viewpoints,
                                                               std::uint64_t seed, int threads) {
  std::vector<ObjectScan> scans;
  std::vector<std::vector<std::size_t>> rows;
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    const std::string name = "clouds[" + std::to_string(k) + "]";
    pcl::Indices indices;
    const Cloud cloud = cloudOf(clouds[k], viewpoints[k], name.c_str());
    const Viewpoint from = viewpointOf(viewpoints[k]);
    {
      const Computing computing;
      scans.push_back(objectScan(cloud, from, indices));
    }
    rows.emplace_back(indices.begin(), indices.end());
    if (cloud.isOrganized()) continue;
    const InputPoints all(name.c_str(), clouds[k], 0, 0);
    for (std::size_t& row : rows.back()) row = all.rows().empty() ? row : all.rows()[row];
  }
  const auto options = optionsWith<CloudRegistrationOptions>(seed, threads);
  RegisteredScans found;
  std::vector<ScanPoint> merged;
  {
    const Computing computing;
    found = registerAll(scans, options);
    merged = found.mergedPoints(scans);
  }
  py::array_t<int> of_points({static_cast<py::ssize_t>(merged.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < merged.size(); ++i) {
    of_points.mutable_at(i, 0) = merged[i].scan;
    of_points.mutable_at(i, 1) = static_cast<int>(rows[merged[i].scan][merged[i].index]);
  }
  return {std::move(found), std::move(of_points)};
}

/// \return the result; if it is empty, the points may be the reason.
/// \throws NoAnswer if they are.
template <typename Found>
Found answerFor(const Cloud& cloud, const pcl::Indices* indices, Found found) {
  if (found.empty()) {
    const Points points = detail::selectPoints(cloud, indices, cloud.size(), 1).points;
    if (const std::string reason = detail::reasonForNoAnswer(points, "points", 0, indices); !reason.empty())
      throw NoAnswer(reason);
  }
  return found;
}

/// The points of a cloud that a class for PCL uses, and the viewpoint that it determines.
class Look : public ScanAnalysis<pcl::PointXYZ> {
public:
  /// \param indices of the object in its scene; none: the whole cloud.
  Look(const Cloud& cloud, const std::optional<pcl::Indices>& indices, const Viewpoint& viewpoint,
       const std::optional<Eigen::Vector4d>& ground, std::size_t max_points, bool as_measured, std::uint64_t seed,
       int threads)
      : ScanAnalysis("points", max_points) {
    setInputCloud(pcl::make_shared<Cloud>(cloud));
    if (indices) setIndices(pcl::make_shared<pcl::Indices>(*indices));
    setViewpoint(viewpoint);
    if (ground) setGround(*ground);
    detail::withBadArguments([&] {
      points_ = selectInput(seed, threads, as_measured);
      if (points_.cols() > 0) seenSpace(points_);
    });
  }

  const Points& points() const { return points_; }
  std::optional<Visibility> visibility() const { return seen() ? std::optional<Visibility>(*seen()) : std::nullopt; }
  bool mayBeRings() const { return hasGivenSupport() && getViewpointSource() != ViewpointSource::Rays; }

private:
  Points points_;
};

/// \return (M, 3) points used, the row of each, what the scanner saw or None, how its viewpoint is known, whether the
/// points may be rings, and why there is no answer.
py::tuple look(const AnyArray& points, const std::optional<pcl::Indices>& indices, const py::object& viewpoint,
               const std::optional<Eigen::Vector4d>& ground, std::size_t max_points, bool as_measured,
               std::uint64_t seed, int threads) {
  const Cloud cloud = cloudOf(points, viewpoint);
  const Viewpoint from = viewpointOf(viewpoint);
  std::optional<Look> found;
  {
    const Computing computing;
    const std::size_t max_used = max_points == 0 ? std::max<std::size_t>(2, cloud.size()) : max_points;
    found.emplace(cloud, indices, from, ground, max_used, as_measured, seed, threads);
  }
  return py::make_tuple(toRows(found->points()), toArray(found->getUsedIndices()), found->visibility(),
                        toString(found->getViewpointSource()), found->mayBeRings(), found->getReason());
}

/// The objects of a scene as a dict.
py::dict sceneOf(const AnyArray& points, const py::object& viewpoint, const std::optional<Eigen::Vector4d>& ground,
                 const SymmetryDatabase* database, const SceneOptions& options) {
  SymmetryScene scene;
  scene.setOptions(options);
  scene.setViewpoint(viewpointOf(viewpoint));
  if (ground) scene.setGround(*ground);
  scene.setInputCloud(pcl::make_shared<Cloud>(cloudOf(points, viewpoint)));
  // Not deleted here: Python holds it.
  if (database) scene.setDatabase({database, [](const void*) {}});
  SceneAnalysis found;
  {
    const Computing computing;
    found = scene.compute();
  }
  py::list objects, supports, junctions;
  for (const SceneObject& object : found.objects) {
    PlaneSearch search;
    static_cast<Detection&>(search.found) = object;
    objects.append(py::dict("planes"_a = search, "indices"_a = toArray(object.indices), "frame"_a = object.frame,
                            "completed_by"_a = object.completed_by,
                            "added"_a = toRows(object.added.getMatrixXfMap(3, 4, 0)), "models"_a = object.models,
                            "model_reason"_a = object.model_reason));
  }
  for (const SupportingPlane& support : found.supports)
    supports.append(py::make_tuple(support.coefficients, toArray(support.indices)));
  for (const SceneJunction& junction : found.junctions)
    junctions.append(
        py::make_tuple(junction.first, junction.second, junction.num_points, junction.together, junction.apart));
  std::optional<Visibility> seen;
  if (found.seen && found.seen->visibility()) seen = *found.seen->visibility();
  return py::dict("reason"_a = found.reason, "alone"_a = found.alone, "objects"_a = objects, "supports"_a = supports,
                  "junctions"_a = junctions, "seen"_a = seen,
                  "viewpoint_from"_a = toString(found.seen ? found.seen->source() : ViewpointSource::None),
                  "plane_distance"_a = found.plane_distance, "cluster_distance"_a = found.cluster_distance);
}

/// \param extension extension for the kind of file, such as .ply.
/// \return its points, (H, W, 3) or (N, 3), (F, 3) triangles, and the position of the sensor, (3,), or None.
/// \throws std::invalid_argument naming the file.
py::tuple read(const std::string& path, std::string text, const std::string& extension) {
  apps::CloudFile file;
  std::vector<Eigen::Vector3d> exact;
  try {
    if (!apps::isBinarySTL(text)) text = apps::withoutMark(std::move(text));
    if (extension == ".pcd" || extension == ".ply") {
      file = extension == ".ply" ? apps::readPLY(path, text) : apps::readPCD(path, text);
    } else {
      apps::ExactShape shape = extension == ".off"   ? apps::readOFF(path, text)
                               : extension == ".obj" ? apps::readOBJ(path, text)
                               : extension == ".stl" ? apps::readSTL(path, text)
                                                     : apps::readColumns(path, text);
      exact = std::move(shape.vertices);
      file.polygons = std::move(shape.polygons);
    }
  } catch (const apps::InputError& error) {
    throw std::invalid_argument(error.what());
  }
  const pcl::PCLPointCloud2& cloud = file.cloud;
  const py::ssize_t height = cloud.height, width = exact.empty() ? cloud.width : exact.size();
  py::array_t<double> points(height > 1 ? std::vector{height, width, py::ssize_t{3}}
                                        : std::vector{width, py::ssize_t{3}});
  std::uint8_t type = exact.empty() ? 0 : pcl::PCLPointField::FLOAT64;
  if (!exact.empty()) std::copy_n(exact.front().data(), 3 * exact.size(), points.mutable_data());
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name != "x" && field.name != "y" && field.name != "z") continue;
    type = std::max(type, field.datatype);
    double* const column = points.mutable_data() + (field.name[0] - 'x');
    for (py::ssize_t i = 0; i < height * width; ++i)
      column[3 * i] = apps::numberAt(&cloud.data[i * cloud.point_step + field.offset], field.datatype);
  }
  std::vector<std::array<int, 3>> faces;
  for (const pcl::Vertices& polygon : file.polygons)
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k)
      faces.push_back({static_cast<int>(polygon.vertices[0]), static_cast<int>(polygon.vertices[k - 1]),
                       static_cast<int>(polygon.vertices[k])});
  const bool is_default = file.sensor_origin.isZero(0.0F) && file.sensor_orientation.vec().isZero(0.0F);
  return py::make_tuple(
      type == pcl::PCLPointField::FLOAT64 ? py::object(points) : points.attr("astype")("float32"), faces,
      is_default ? py::none() : py::cast(Eigen::Vector3d(file.sensor_origin.head<3>().cast<double>())));
}

/// Normals or directions, and weights.
using Weighted = std::vector<std::pair<Eigen::Vector3d, double>>;

/// \param planes normals and weights; the first num_symmetries are symmetries of the whole object.
/// \param points points of the object; None: views hide nothing.
/// \return direction, score and pose of the good views, or of the worst one alone.
std::vector<std::tuple<Eigen::Vector3d, double, RowMajor4>> views(const Weighted& planes, std::size_t num_symmetries,
                                                                  const Weighted& axes, const Weighted& maxima,
                                                                  const py::object& points, int number,
                                                                  const Eigen::Vector3d& up, double separation,
                                                                  bool worst) {
  std::vector<SymmetryPlane> weighted;
  for (const auto& [normal, weight] : planes) {
    weighted.emplace_back(ReflectionPlane(normal, 0.0));
    weighted.back().score = weight;
    weighted.back().kind = weighted.size() <= num_symmetries ? PlaneKind::Symmetry : PlaneKind::Approximate;
  }
  std::vector<SymmetryAxis> lines;
  for (const auto& [direction, weight] : axes) lines.push_back({{}, direction, 0.0, weight});
  std::vector<LocalMaximum> across;
  for (const auto& [normal, value] : maxima) across.push_back({{}, ReflectionPlane(normal, 0.0), value});
  ViewpointSelection selection;
  selection.setPlanes(weighted, lines, across);
  auto cloud = pcl::make_shared<Cloud>();
  if (points.is_none()) {  // a line that no view is along
    cloud->emplace_back(0.0F, 0.0F, 0.0F);
    cloud->emplace_back(0.537F, 0.621F, 0.571F);
  } else {
    *cloud = cloudOf(arrayOf("points", points));
  }
  selection.setInputCloud(cloud);
  selection.setUp(up);
  selection.setSeparation(separation);
  const Computing computing;
  const std::vector<SelectedView> chosen =
      worst ? std::vector{selection.getWorstView()} : selection.getGoodViews(number);
  std::vector<std::tuple<Eigen::Vector3d, double, RowMajor4>> result;
  for (const SelectedView& view : chosen)
    result.emplace_back(view.direction, view.score, RowMajor4(view.pose.matrix().cast<double>()));
  return result;
}

/// What a function of the package returns, such as the points of a file.
py::object called(const py::object& points) {
  if (!py::isinstance<py::function>(points)) return points;
  try {
    return points();
  } catch (const py::error_already_set& error) {
    throw std::invalid_argument(py::str(error.value()).cast<std::string>());
  }
}

/// Models from a mapping of names to points, or from pairs of both. Points become clouds when they are used.
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
    // Shared, because the threads that copy it do not hold the lock of the interpreter.
    const auto held = std::make_shared<py::object>(std::move(model.second));
    inputs.push_back({model.first, {}, [held] {
                        const py::gil_scoped_acquire acquire;
                        return cloudOf(arrayOf("points", called(*held)));
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
  const Computing computing;
  return database.build(inputs, told);
}

void addDatabase(py::module_& module) {
  using Unlocked = py::call_guard<Computing>;
  py::class_<SymmetryDatabase>(module, "Database")
      .def(py::init([](const std::string& file, const std::string& unit, int threads) {
             DatabaseOptions options;
             options.unit = unit;
             options.num_threads = threads;
             return std::make_unique<SymmetryDatabase>(file, options);
           }),
           py::arg("file"), py::arg("unit"), py::arg("threads"))
      .def_property_readonly("names", &SymmetryDatabase::names)
      .def_property_readonly("unit", &SymmetryDatabase::unit)
      .def("__len__", &SymmetryDatabase::size)
      .def("__contains__", &SymmetryDatabase::contains)
      .def(
          "add",
          [](SymmetryDatabase& database, const std::string& name, const AnyArray& points) {
            const Cloud cloud = cloudOf(points);
            const Computing computing;
            database.add(name, cloud);
          },
          py::arg("name"), py::arg("points"))
      .def("build", &build, py::arg("models"), py::arg("progress"))
      .def(
          "merge", [](SymmetryDatabase& d, const std::vector<std::string>& files) { return d.merge(files); },
          Unlocked())
      .def("remove", &SymmetryDatabase::remove, py::arg("name"))
      .def(
          "cloud",
          [](const SymmetryDatabase& database, const std::string& name) {
            return toRows(database.cloud(name).getMatrixXfMap(3, 4, 0));
          },
          py::arg("name"))
      .def(
          "match",
          [](const SymmetryDatabase& database, const AnyArray& points, int num_nearest, const py::object& viewpoint) {
            const Cloud cloud = cloudOf(points, viewpoint);
            const Viewpoint from = viewpointOf(viewpoint);
            const Computing computing;
            return answerFor(cloud, nullptr, database.match(cloud, num_nearest, from));
          },
          py::arg("points"), py::arg("num_nearest"), py::arg("viewpoint"))
      .def(
          "recognize",
          [](const SymmetryDatabase& database, const AnyArray& points, const std::optional<pcl::Indices>& indices,
             const py::object& viewpoint, double min_confidence, int threads) {
            const Cloud cloud = cloudOf(points, viewpoint);
            const Viewpoint from = viewpointOf(viewpoint);
            RecognitionOptions options;
            options.min_confidence = min_confidence;
            options.num_threads = threads;
            const Computing computing;
            if (!indices) return answerFor(cloud, nullptr, database.recognize(cloud, options, from));
            const auto seen = std::make_shared<const SeenSpace>(cloud, from);
            return answerFor(cloud, &*indices, database.recognize(cloud, *indices, options, seen));
          },
          py::arg("points"), py::arg("indices"), py::arg("viewpoint"), py::arg("min_confidence"), py::arg("threads"));
}

void addScenes(py::module_& module) {
  add(module, "read", &read, "path", "text", "extension");
  add(module, "views", &views, "planes", "num_symmetries", "axes", "maxima", "points", "number", "up", "separation",
      "worst");
  add(module, "look", &look, "points", "indices", "viewpoint", "ground", "max_points", "as_measured", "seed",
      "threads");
  py::class_<SceneOptions>(module, "SceneOptions")
      .def(py::init([](double plane_distance, double cluster_distance, int min_points, double max_range, int max_points,
                       bool separate, bool frames, bool complete, double min_confidence, double min_name_confidence,
                       std::uint64_t seed, int threads) {
             SceneOptions o;
             o.plane_distance = plane_distance;
             o.cluster_distance = cluster_distance;
             o.min_points = min_points;
             o.max_range = max_range;
             o.max_points = max_points;
             o.separate = separate;
             o.frames = frames;
             o.complete = complete;
             o.detection.min_confidence = min_confidence;
             o.recognition.min_confidence = min_name_confidence;
             o.detection.seed = o.frame.seed = seed;
             o.num_threads = o.detection.num_threads = o.frame.num_threads = o.completion.num_threads =
                 o.recognition.num_threads = threads;
             return o;
           }),
           py::arg("plane_distance"), py::arg("cluster_distance"), py::arg("min_points"), py::arg("max_range"),
           py::arg("max_points"), py::arg("separate"), py::arg("frames"), py::arg("complete"),
           py::arg("min_confidence"), py::arg("min_name_confidence"), py::arg("seed"), py::arg("threads"));
  add(module, "scene", &sceneOf, "points", "viewpoint", "ground", "database", "options");
}

}  // namespace

PYBIND11_MODULE(_recognition, module) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // the package reports the reasons
  py::module_::import("pcl_symmetry._pcl_symmetry");        // has the classes that both use, and NoAnswer
  addComputing(module);
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
  add(module, "register_all", &registerAllPoints, "clouds", "viewpoints", "seed", "threads");
  add(module, "register", &registerPoints, "source", "target", "guess", "around", "source_viewpoint",
      "target_viewpoint", "seed", "threads");
  addDatabase(module);
  addScenes(module);
}

}  // namespace python
}  // namespace pcl_symmetry
