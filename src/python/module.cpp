/// The Python module: the functions of the core on arrays of NumPy. Formulas stand in the core; here are names,
/// defaults, shapes and words.
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/mesh_sampling.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/local_symmetry.h"
#include "pcl_symmetry/core/mesh_refinement.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/published_planes.h"
#include "pcl_symmetry/core/revolution_profile.h"
#include "pcl_symmetry/core/surface_segmentation.h"
#include "pcl_symmetry/core/symmetric_completion.h"
#include "pcl_symmetry/core/symmetrized_shape.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/viewpoint_score.h"
#include "pcl_symmetry/core/volume_planes.h"
#include "python/evidence.h"
#include "python/input_points.h"
#include "python/motions.h"
#include "python/plane_results.h"
#include "python/rotations.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

/// Points as rows.
py::array_t<float> rowsOf(const PointsRef& points) {
  py::array_t<float> result({static_cast<py::ssize_t>(points.cols()), py::ssize_t{3}});
  Eigen::Map<Points>(result.mutable_data(), 3, points.cols()) = points;
  return result;
}

std::vector<std::vector<int>> polygonsOf(const py::array& faces) {
  const char kind = faces.dtype().kind();
  if (faces.ndim() != 2 || faces.shape(1) < 3 || (kind != 'i' && kind != 'u' && kind != 'f'))
    throw std::invalid_argument("faces = array of another shape or kind, must be (F, 3), indices into the vertices");
  const py::array_t<double, py::array::forcecast> rows(faces);
  const auto index = rows.unchecked<2>();
  std::vector<std::vector<int>> polygons(static_cast<std::size_t>(faces.shape(0)));
  for (py::ssize_t i = 0; i < faces.shape(0); ++i)
    for (py::ssize_t k = 0; k < faces.shape(1); ++k) {
      const double corner = index(i, k);
      if (!(corner >= 0.0 && corner <= std::numeric_limits<int>::max() && corner == std::floor(corner)))
        throw std::invalid_argument("faces: " + py::str(py::float_(corner)).cast<std::string>() +
                                    ", must be an index of a vertex");
      polygons[static_cast<std::size_t>(i)].push_back(static_cast<int>(corner));
    }
  return polygons;
}

/// Vertices and triangles of a mesh.
struct MeshInput {
  MeshInput(const AnyArray& vertex_rows, const AnyArray& faces) : vertices("vertices", vertex_rows, 0, 0) {
    if (!vertices.usesAllRows()) throw std::invalid_argument("vertices: not all finite, must be");
    for (const std::vector<int>& polygon : polygonsOf(faces.array))
      for (std::size_t k = 2; k < polygon.size(); ++k) triangles.emplace_back(polygon[0], polygon[k - 1], polygon[k]);
  }

  InputPoints vertices;
  std::vector<Eigen::Vector3i> triangles;
};

py::array_t<float> sampleMesh(const AnyArray& vertices, const AnyArray& faces, int num_points, std::uint64_t seed) {
  const MeshInput mesh(vertices, faces);
  return rowsOf(sampleTriangles(mesh.vertices.points(), mesh.triangles, num_points, seed));
}

MeshSurface meshSurface(const AnyArray& vertices, const AnyArray& faces) {
  const MeshInput mesh(vertices, faces);
  const py::gil_scoped_release release;
  return {mesh.vertices.points(), mesh.triangles};
}

/// \return options with their seed and number of threads.
template <typename Options>
Options optionsWith(std::uint64_t seed, int threads) {
  Options options;
  options.seed = seed;
  options.num_threads = threads;
  return options;
}

/// \return the enumerator whose name, in their order, is \p value.
/// \throws std::invalid_argument for another name.
template <typename Enum>
Enum named(const char* parameter, const std::string& value, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == value) return static_cast<Enum>(i);
  std::string known = names[0];
  for (std::size_t i = 1; i < names.size(); ++i) known += (i + 1 < names.size() ? ", " : " or ") + names[i];
  throw std::invalid_argument(parameter + (" = " + value) + ", must be " + known);
}

TransformMethod methodNamed(const std::string& method) {
  return named<TransformMethod>("method", method, {"sampled", "convolution", "rotational", "voting"});
}

/// \param faces None for a cloud.
SymmetrizedShape symmetrize(const AnyArray& points, const py::object& faces, const ReflectionPlane& plane,
                            const std::string& half, int threads) {
  const auto kept = named<SymmetrizedHalf>("half", half, {"mean", "left", "right"});
  if (!faces.is_none()) {
    const MeshInput mesh(points, {arrayOf("faces", faces)});
    const py::gil_scoped_release release;
    return symmetrizedMesh(mesh.vertices.points(), mesh.triangles, plane, kept, threads);
  }
  const InputPoints input("points", points, 0, 0);
  if (!input.usesAllRows()) throw std::invalid_argument("points: not all finite, must be");
  const py::gil_scoped_release release;
  return symmetrizedCloud(input.points(), plane, kept, threads);
}

/// \return vertices, faces, and the row that each vertex comes from.
py::tuple mirroredHalfOf(const AnyArray& vertices, const py::object& faces, const ReflectionPlane& plane, bool left) {
  const MeshInput mesh(vertices, {arrayOf("faces", faces)});
  const MirroredMesh half = mirroredHalf(mesh.vertices.points(), mesh.triangles, plane, left);
  Eigen::MatrixX3i triangles(half.triangles.size(), 3);
  for (std::size_t i = 0; i < half.triangles.size(); ++i) triangles.row(i) = half.triangles[i];
  return py::make_tuple(rowsOf(half.vertices), triangles, half.sources);
}

/// \return (K, 4): radius, height, spread, count.
Eigen::MatrixXd revolutionProfileOf(const AnyArray& points, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& direction, int num_points) {
  const InputPoints input("points", points, 0, 0);
  SymmetryAxis axis;
  axis.point = point;
  axis.direction = direction;
  const py::gil_scoped_release release;
  const std::vector<ProfilePoint> profile = revolutionProfile(input.points(), axis, num_points);
  Eigen::MatrixXd rows(profile.size(), 4);
  for (std::size_t i = 0; i < profile.size(); ++i)
    rows.row(i) << profile[i].radius, profile[i].height, profile[i].spread, profile[i].count;
  return rows;
}

PlaneSearch planes(const py::array& points, const py::object& viewpoint, DetectionOptions options,
                   std::size_t max_points, const py::object& normals, const std::optional<MeshSurface>& mesh) {
  const InputPoints input("points", points, max_points, options.seed);
  std::optional<Points> given;
  if (!normals.is_none()) given = input.atPoints("normals", arrayOf("normals", normals));
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  const PointsRef used = input.points();
  PlaneInput cloud(used, seen ? &*seen : nullptr);
  if (given) cloud.normals = &*given;
  PlaneSearch search;
  if (seen) search.viewpoint = seen->viewpoint();
  {
    const py::gil_scoped_release release;
    search.found = detectPlanes(cloud, options);
    if (mesh && !seen) refineOnMesh(*mesh, search.found, options);
  }
  search.num_rows = input.numRows();
  search.rows = input.rows();
  return search;
}

/// First index along x, as nibabel has it.
using VolumeArray = py::array_t<float, py::array::f_style | py::array::forcecast>;

ScalarGrid gridOf(const VolumeArray& volume, const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                  const Eigen::Matrix3d& direction) {
  if (volume.ndim() != 3) throw std::invalid_argument("volume = array of another shape, must have three axes");
  const ScalarGrid::Size size{static_cast<int>(volume.shape(0)), static_cast<int>(volume.shape(1)),
                              static_cast<int>(volume.shape(2))};
  return ScalarGrid(size, ScalarGrid::placed(spacing, origin, direction),
                    std::vector<float>(volume.data(), volume.data() + volume.size()));
}

PlaneSearch volumePlanes(const VolumeArray& volume, const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                         const Eigen::Matrix3d& direction, const std::pair<double, double>& levels, bool approximate,
                         int max_planes, std::uint64_t seed, int threads) {
  const ScalarGrid grid = gridOf(volume, spacing, origin, direction);
  const py::gil_scoped_release release;
  auto options = optionsWith<DetectionOptions>(seed, threads);
  options.approximate = approximate;
  options.max_planes = max_planes;
  PlaneSearch search;
  search.found = detectVolumePlanes(grid, options, {levels.first, levels.second});
  return search;
}

/// \return PRST, PRSD and GEDT.
std::vector<std::vector<float>> descriptors(const AnyArray& points, bool input_axes, bool by_equation_1,
                                            std::uint64_t seed, int threads) {
  const InputPoints input("points", points, 20'000, seed);
  const py::gil_scoped_release release;
  auto options = optionsWith<DescriptorOptions>(seed, threads);
  options.by_equation_1 = by_equation_1;
  Eigen::Isometry3d T_frame_input(Eigen::Translation3d(-centerOfMass(input.points())));
  if (!input_axes)
    T_frame_input = symmetryFrame(input.points(), optionsWith<FrameOptions>(seed, threads)).T_canonical_input;
  SymmetryDescriptors all = symmetryDescriptors(input.points(), T_frame_input, options);
  return {std::move(all.prst), std::move(all.prsd), std::move(all.gedt)};
}

PlaneSearch publishedPlanesOf(const AnyArray& points, const std::string& method, int num_points, std::uint64_t seed,
                              int threads) {
  const InputPoints input("points", points, 0, seed);
  const TransformMethod estimator = methodNamed(method);
  const py::gil_scoped_release release;
  const GaussianEdt edt(input.points());
  auto options = optionsWith<PublishedOptions>(seed, threads);
  options.num_points = num_points;
  PlaneSearch search;
  search.found.planes =
      publishedPlanes(input.points(), edt, publishedMap(input.points(), edt, estimator, seed, threads), options);
  return search;
}

std::vector<float> localSymmetryOf(const AnyArray& points, double scale, std::uint64_t seed, int threads) {
  const InputPoints input("points", points, 0, seed);
  const py::gil_scoped_release release;
  const GaussianEdt edt(input.points());
  auto options = optionsWith<LocalSymmetryOptions>(seed, threads);
  options.scale = scale * edt.radius();
  return localSymmetry(edt, input.points(), options);
}

SymmetryFrame frame(const AnyArray& points, const py::object& viewpoint, std::size_t max_points, bool as_published,
                    std::uint64_t seed, int threads, const std::optional<MeshSurface>& mesh) {
  const InputPoints input("points", points, max_points, seed);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  const py::gil_scoped_release release;
  auto options = optionsWith<FrameOptions>(seed, threads);
  options.as_published = as_published;
  SymmetryFrame found = symmetryFrame(input.answerablePoints(), options, seen ? &*seen : nullptr);
  if (mesh && !seen) refineOnMesh(*mesh, found);
  return found;
}

/// \return the added points, and the rows that they are the reflections of.
std::pair<py::array_t<float>, std::vector<std::size_t>> complete(const AnyArray& points, const ReflectionPlane& plane,
                                                                 const py::object& viewpoint, int threads) {
  const InputPoints input("points", points, 0, 0);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  CompletionOptions options;
  options.num_threads = threads;
  Points added;
  std::vector<std::size_t> rows;
  {
    const py::gil_scoped_release release;
    const PointsRef all = input.points();
    const std::vector<int> completing = completingPoints(all, plane, options, seen ? &*seen : nullptr);
    added.resize(3, static_cast<Eigen::Index>(completing.size()));
    for (std::size_t i = 0; i < completing.size(); ++i) {
      const auto source = static_cast<std::size_t>(completing[i]);
      added.col(static_cast<Eigen::Index>(i)) = plane.reflect(all.col(completing[i]).cast<double>()).cast<float>();
      rows.push_back(input.rows().empty() ? source : input.rows()[source]);
    }
  }
  return {rowsOf(added), rows};
}

std::vector<int> segmentCloud(const py::array& points, const SegmentationOptions& options) {
  constexpr int kMostPoints = 30'000, kNumNeighbors = 12;  // as in SymmetrySegmentation
  const InputPoints input("points", points, kMostPoints, options.seed);
  const py::gil_scoped_release release;
  const PointsRef used = input.points();
  if (used.cols() <= kNumNeighbors) throw std::invalid_argument("points: too few to have parts, must be more than 12");
  const auto neighbors = nearestOthers(used, *makeFlannSearch(used), kNumNeighbors, options.num_threads);
  const Segmentation parts = segmentSurface(cloudGraph(used, neighbors), options);
  std::vector<int> labels(input.numRows(), -1);
  if (input.rows().empty()) return parts.labels;
  for (std::size_t i = 0; i < input.rows().size(); ++i) labels[input.rows()[i]] = parts.labels[i];
  return labels;
}

std::vector<int> segment(const AnyArray& points, const py::object& faces, int parts, const std::string& method,
                         int depth, bool as_published, const std::function<void(double)>& progress, std::uint64_t seed,
                         int threads) {
  auto options = optionsWith<SegmentationOptions>(seed, threads);
  options.num_parts = parts;
  options.method = named<SegmentationMethod>("method", method, {"merging", "splitting"});
  options.splitting.depth = depth;
  options.splitting.as_published = as_published;
  if (progress)
    options.progress = [&progress](double share) {
      const py::gil_scoped_acquire acquire;
      progress(share);
    };
  if (faces.is_none()) return segmentCloud(points, options);
  const InputPoints input("points", points, 0, seed);
  if (!input.usesAllRows()) throw std::invalid_argument("points: vertices not all finite, must be");
  const std::vector<std::vector<int>> polygons = polygonsOf(arrayOf("faces", faces));
  const py::gil_scoped_release release;
  return segmentSurface(meshGraph(input.points(), polygons), options).labels;
}

Eigen::MatrixXf describe(const AnyArray& points, const py::object& viewpoint, std::uint64_t seed, int threads) {
  const InputPoints input("points", points, 0, seed);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  const py::gil_scoped_release release;
  const auto options = optionsWith<DescriptionOptions>(seed, threads);
  return describeShape(input.answerablePoints(), options, seen ? &*seen : nullptr).signatures.transpose();
}

SymmetryMap transform(const AnyArray& points, const std::array<int, 3>& bins, const std::string& method,
                      const Eigen::Vector3d& center, double radius, double sigma, bool as_published, std::uint64_t seed,
                      int threads) {
  const InputPoints input("points", points, 0, seed);
  PlanarTransformOptions options;
  options.method = methodNamed(method);
  if (as_published) options.voting.near_distance = 0.0;
  options.setSeed(seed);
  options.setNumThreads(threads);
  const py::gil_scoped_release release;
  GaussianEdtOptions edt_options;
  edt_options.center = center;
  edt_options.radius = radius;
  edt_options.sigma = sigma;
  edt_options.num_threads = threads;
  const GaussianEdt edt(input.points(), edt_options);
  const PlaneGrid grid(bins[0], bins[1], bins[2], edt.center(), edt.radius());
  return planarTransform(edt, grid, centerOfMass(input.points()), options);
}

std::vector<RankedView> viewpoints(const std::vector<std::pair<Eigen::Vector3d, double>>& planes) {
  std::vector<ViewPlane> view_planes;
  for (const auto& [normal, score] : planes) view_planes.push_back({normal, score});
  return bestViews(view_planes);
}

/// \return for each query the row of the closest point, and its distance in input units.
std::pair<py::array_t<int>, py::array_t<float>> closest(const AnyArray& points, const AnyArray& queries) {
  const InputPoints input("points", points, 0, 0), asked("queries", queries, 0, 0);
  std::vector<int> indices;
  std::vector<float> distances;
  {
    const py::gil_scoped_release release;
    makeFlannSearch(input.points())->search(asked.points(), 1, indices, distances);
    for (float& distance : distances) distance = std::sqrt(distance);
  }
  const auto size = static_cast<py::ssize_t>(indices.size());
  return {py::array_t<int>(size, indices.data()), py::array_t<float>(size, distances.data())};
}

void addFrame(py::module_& module) {
  py::class_<ProbableFrame>(module, "ProbableFrame", "A frame that may be the shape's own.")
      .def_readonly("center", &ProbableFrame::center, "(3,) center of symmetry, frame and units of the input")
      .def_readonly("axes", &ProbableFrame::axes, "(3, 3) axes in columns, orthonormal, right-handed")
      .def_readonly("revolution_axis", &ProbableFrame::revolution_axis, "as of `Frame`")
      .def_readonly(
          "probability", &ProbableFrame::probability,
          "that the axes are the shape's own, in any order and sign, at any angle about an axis of revolution");
  py::class_<SymmetryFrame>(module, "Frame",
                            "Canonical frame of a shape (Section 5.1): center and principal symmetry axes.")
      .def_readonly("center", &SymmetryFrame::center, "(3,) center of symmetry, frame and units of the input")
      .def_readonly("axes", &SymmetryFrame::axes, "(3, 3) axes in columns, orthonormal, right-handed, best first")
      .def_readonly("scores", &SymmetryFrame::scores, "(3,) score of the plane across each axis, in [0, 1]")
      .def_readonly("revolution_axis", &SymmetryFrame::revolution_axis,
                    "column that is an axis of revolution; -1: none, 3: every line through the center")
      .def_property_readonly(
          "transform", [](const SymmetryFrame& f) { return RowMajor4(f.T_canonical_input.matrix()); },
          "(4, 4) from the input to the canonical frame")
      .def_property_readonly(
          "equivalent", [](const SymmetryFrame& f) { return stacked(f.equivalent); },
          "(K, 4, 4) all transforms that symmetry leaves equally good, `transform` first")
      .def_property_readonly(
          "turns", [](const SymmetryFrame& f) { return f.turns; },
          "list of Turn, of scans from one side, most confident first")
      .def_readonly("probable", &SymmetryFrame::probable,
                    "list of `ProbableFrame`: this frame, then others by falling probability")
      .def_property_readonly("evidence", &frameEvidence);
}

void addMap(py::module_& module) {
  py::class_<SymmetryMap>(module, "Map", "The transform D(f, gamma) of equation 2 on a grid of planes.")
      .def_property_readonly(
          "values",
          [](const py::object& self) {
            const auto& map = self.cast<const SymmetryMap&>();
            const std::vector<py::ssize_t> shape{map.grid.numTheta(), map.grid.numPhi(), map.grid.numRadius()};
            return py::array_t<float>(shape, map.values.data(), self);
          },
          "(theta, phi, r) values of D, 1 for a perfect symmetry; a view of the map's memory")
      .def_property_readonly("center", [](const SymmetryMap& map) { return map.grid.center(); })
      .def_property_readonly("radius", [](const SymmetryMap& map) { return map.grid.radius(); })
      .def_readonly("sigma", &SymmetryMap::sigma, "width of the Gaussian, input units");
}

void addPlaneFunctions(py::module_& module) {
  const DetectionOptions standard;
  module.def(
      "planes",
      [](const AnyArray& points, const py::object& viewpoint, double tolerance, double absolute_tolerance,
         bool approximate, int max_planes, const py::object& normals, std::size_t max_points, bool evidence,
         std::uint64_t seed, int threads, const std::optional<MeshSurface>& mesh) {
        auto options = optionsWith<DetectionOptions>(seed, threads);
        options.tolerance = tolerance;
        options.absolute_tolerance = absolute_tolerance;
        options.approximate = approximate;
        options.max_planes = max_planes;
        options.evidence = evidence;
        return planes(points, viewpoint, options, max_points, normals, mesh);
      },
      py::arg("points"), py::kw_only(), py::arg("viewpoint") = "auto", py::arg("tolerance") = standard.tolerance,
      py::arg("absolute_tolerance") = 0.0, py::arg("approximate") = false, py::arg("max_planes") = standard.max_planes,
      py::arg("normals") = py::none(), py::arg("max_points") = 50'000, py::arg("evidence") = false, py::arg("seed") = 1,
      py::arg("threads") = 0, py::arg("mesh") = py::none(),
      "Planes of symmetry of a cloud (Sections 4.1 to 4.4).\n\n"
      "points: (N, 3), input units; float32 rows are not copied. Rows that are not finite are left out.\n"
      "viewpoint: where the scanner stood: \"auto\" (the points decide), None (seen from all sides) or (x, y, z).\n"
      "tolerance: how far a symmetric surface may be off, share of the greatest distance between two points, in (0, "
      "0.1].\n"
      "absolute_tolerance: the same in input units; 0: tolerance decides.\n"
      "approximate: also the other maxima of the transform, and symmetries of parts.\n"
      "normals: (N, 3), of any length and sign; None: estimated.\n"
      "max_points: larger clouds are thinned to that number. threads: 0 = one per core.\n"
      "evidence: also what the decisions are taken from, `evidence` and `turn_evidence` of the result; takes about as\n"
      "long again.\n"
      "Returns Planes. Raises ValueError for bad parameters.");
  module.def("descriptors", &descriptors, py::arg("points"), py::kw_only(), py::arg("input_axes"),
             py::arg("by_equation_1"), py::arg("seed"), py::arg("threads"));
  module.def("volume_planes", &volumePlanes, py::arg("volume"), py::kw_only(), py::arg("spacing"), py::arg("origin"),
             py::arg("direction"), py::arg("levels"), py::arg("approximate"), py::arg("max_planes"), py::arg("seed"),
             py::arg("threads"));
  module.def("published_planes", &publishedPlanesOf, py::arg("points"), py::kw_only(), py::arg("method"),
             py::arg("num_points"), py::arg("seed"), py::arg("threads"));
  module.def("local_symmetry", &localSymmetryOf, py::arg("points"), py::arg("scale"), py::kw_only(), py::arg("seed"),
             py::arg("threads"));
  module.def(
      "complete", &complete, py::arg("points"), py::arg("plane"), py::kw_only(), py::arg("viewpoint") = "auto",
      py::arg("threads") = 0,
      "Completes a scan by its reflection in a plane.\n\n"
      "Returns (added, rows): (M, 3) points that neither fall onto the measured surface nor into space that was\n"
      "seen to be empty, and the row of the point that each is the reflection of.");
  module.def("viewpoints", &viewpoints, py::arg("planes"),
             "Directions from the object to the camera that show the least repetition (Section 5.4).\n\n"
             "planes: list of Plane. Returns a list of View, best first.");
}

void addMeshFunctions(py::module_& module) {
  py::class_<MeshSurface>(module, "MeshSurface", "A mesh as the exact surface that symmetries are refined on.")
      .def(py::init(&meshSurface), py::arg("vertices"), py::arg("faces"));
  py::class_<SymmetrizedShape>(module, "Symmetrized")
      .def_property_readonly("points", [](const SymmetrizedShape& s) { return rowsOf(s.points); })
      .def_readonly("kept", &SymmetrizedShape::kept)
      .def_property_readonly(
          "asymmetry",
          [](const SymmetrizedShape& s) { return py::array_t<float>(s.asymmetry.size(), s.asymmetry.data()); })
      .def_readonly("mean_asymmetry", &SymmetrizedShape::mean_asymmetry)
      .def_readonly("greatest_asymmetry", &SymmetrizedShape::greatest_asymmetry)
      .def_readonly("deviation", &SymmetrizedShape::deviation);
  module.def("symmetrize", &symmetrize, py::arg("points"), py::arg("faces"), py::arg("plane"), py::arg("half"),
             py::arg("threads"));
  module.def("mirrored_half", &mirroredHalfOf, py::arg("vertices"), py::arg("faces"), py::arg("plane"),
             py::arg("left"));
  module.def("profile", &revolutionProfileOf, py::arg("points"), py::arg("point"), py::arg("direction"),
             py::arg("num_points"));
}

void addShapeFunctions(py::module_& module) {
  module.def("sample_mesh", &sampleMesh, py::arg("vertices"), py::arg("faces"), py::arg("num_points") = 10'000,
             py::kw_only(), py::arg("seed") = 1,
             "(num_points, 3) points spread evenly over a mesh of (V, 3) vertices and (F, 3) faces.");
  module.def("frame", &frame, py::arg("points"), py::kw_only(), py::arg("viewpoint") = "auto",
             py::arg("max_points") = 50'000, py::arg("as_published") = false, py::arg("seed") = 1,
             py::arg("threads") = 0, py::arg("mesh") = py::none(),
             "Canonical frame of a cloud (Section 5.1). Parameters as in planes(). Returns Frame.");
  module.def("closest", &closest, py::arg("points"), py::arg("queries"));
  module.def("segment", &segment, py::arg("points"), py::arg("faces") = py::none(), py::kw_only(), py::arg("parts") = 0,
             py::arg("method") = "merging", py::arg("depth") = 3, py::arg("as_published") = false,
             py::arg("progress") = py::none(), py::arg("seed") = 1, py::arg("threads") = 0,
             "Cuts a surface into parts by its symmetries (Section 5.3). See pcl_symmetry.segment.");
  module.def("describe", &describe, py::arg("points"), py::kw_only(), py::arg("viewpoint") = "auto",
             py::arg("seed") = 1, py::arg("threads") = 0,
             "(2, K) signatures of unit norm, the same in all poses and sizes (Section 5.2).");
  module.def("transform", &transform, py::arg("points"), py::arg("bins") = std::array<int, 3>{64, 64, 64},
             py::kw_only(), py::arg("method") = "sampled", py::arg("center") = py::make_tuple(0.0, 0.0, 0.0),
             py::arg("radius") = 0.0, py::arg("sigma") = 0.0, py::arg("as_published") = false, py::arg("seed") = 1,
             py::arg("threads") = 0);
}

}  // namespace

PYBIND11_MODULE(_pcl_symmetry, module) {
  addEvidence(module);
  addPlaneResults(module);
  addFrame(module);
  addMap(module);
  addMeshFunctions(module);
  addPlaneFunctions(module);
  addShapeFunctions(module);
  addRotations(module);
  module.attr("__version__") = PCL_SYMMETRY_VERSION;
}

}  // namespace pcl_symmetry::python
