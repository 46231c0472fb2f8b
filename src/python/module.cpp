/// The core of the Python package: functions on arrays of NumPy. The package adds defaults and documentation.
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

#include "core/base/check.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/triangles.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "core/scan/range_image.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/local_symmetry.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/published_planes.h"
#include "pcl_symmetry/core/revolution_profile.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/surface_segmentation.h"
#include "pcl_symmetry/core/symmetric_completion.h"
#include "pcl_symmetry/core/symmetrized_shape.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/volume_planes.h"
#include "python/computing.h"
#include "python/input_points.h"
#include "python/motions.h"
#include "python/results.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

/// Vertices and triangles of a mesh.
struct MeshInput {
  MeshInput(const AnyArray& vertex_rows, const py::object& faces) : vertices("vertices", vertex_rows, 0, 0) {
    if (!vertices.usesAllRows()) throw std::invalid_argument("vertices: not all finite, must be");
    for (const std::vector<int>& polygon : polygonsOf(faces))
      for (std::size_t k = 2; k < polygon.size(); ++k) triangles.emplace_back(polygon[0], polygon[k - 1], polygon[k]);
  }

  InputPoints vertices;
  std::vector<Eigen::Vector3i> triangles;
};

py::array_t<float> sampleMesh(const AnyArray& vertices, const py::object& faces, int num_points, std::uint64_t seed) {
  const MeshInput mesh(vertices, faces);
  return toRows(sampleTriangles(mesh.vertices.points(), mesh.triangles, num_points, seed));
}

MeshSurface meshSurface(const AnyArray& vertices, const py::object& faces) {
  const MeshInput mesh(vertices, faces);
  const Computing computing;
  return {mesh.vertices.points(), mesh.triangles};
}

/// \return the enumerator whose name is \p value; names are in the order of the enumerators.
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
  checkNumThreads(threads);
  if (!faces.is_none()) {
    const MeshInput mesh(points, faces);
    const Computing computing;
    return symmetrizedMesh(mesh.vertices.points(), mesh.triangles, plane, kept, threads);
  }
  const InputPoints input("points", points, 0, 0);
  const Computing computing;
  const SymmetrizedShape found = symmetrizedCloud(input.points(), plane, kept, threads);
  const std::vector<std::size_t>& rows = input.rows();
  if (rows.empty()) return found;
  SymmetrizedShape all = found;  // the other rows are not finite
  all.points = Points::Constant(3, static_cast<Eigen::Index>(input.numRows()), std::nanf(""));
  all.points(Eigen::all, rows) = found.points;
  all.asymmetry.assign(input.numRows(), std::nanf(""));
  for (std::size_t i = 0; i < rows.size(); ++i) all.asymmetry[rows[i]] = found.asymmetry[i];
  for (int& row : all.kept) row = static_cast<int>(rows[row]);
  return all;
}

/// \return vertices, faces, and the row that each vertex comes from.
py::tuple mirroredHalfOf(const AnyArray& vertices, const py::object& faces, const ReflectionPlane& plane, bool left) {
  const MeshInput mesh(vertices, faces);
  const MirroredMesh half = mirroredHalf(mesh.vertices.points(), mesh.triangles, plane, left);
  Eigen::MatrixX3i triangles(half.triangles.size(), 3);
  for (std::size_t i = 0; i < half.triangles.size(); ++i) triangles.row(i) = half.triangles[i];
  return py::make_tuple(toRows(half.vertices), triangles, half.sources);
}

/// \return (K, 4): radius, height, spread, count.
Eigen::MatrixXd revolutionProfileOf(const AnyArray& points, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& direction, int num_points) {
  const InputPoints input("points", points, 0, 0);
  SymmetryAxis axis;
  axis.point = point;
  axis.direction = direction;
  const Computing computing;
  const std::vector<ProfilePoint> profile = revolutionProfile(input.points(), axis, num_points);
  Eigen::MatrixXd rows(profile.size(), 4);
  for (std::size_t i = 0; i < profile.size(); ++i)
    rows.row(i) << profile[i].radius, profile[i].height, profile[i].spread, profile[i].count;
  return rows;
}

PlaneSearch planes(const AnyArray& points, const py::object& viewpoint, std::optional<double> tolerance,
                   double absolute_tolerance, double min_confidence, bool approximate, int max_planes,
                   const py::object& normals, std::size_t max_points, bool evidence, std::uint64_t seed, int threads,
                   const std::optional<MeshSurface>& mesh, bool may_be_rings) {
  auto options = optionsWith<DetectionOptions>(seed, threads);
  if (tolerance) options.tolerance = options.max_tolerance = *tolerance;
  options.absolute_tolerance = absolute_tolerance;
  options.min_confidence = min_confidence;
  options.min_possible = std::min(options.min_possible, min_confidence);
  options.approximate = approximate;
  options.max_planes = max_planes;
  const InputPoints input("points", points, max_points, seed);
  std::optional<Points> given;
  if (!normals.is_none()) given = input.atPoints("normals", arrayOf("normals", normals));
  const PointsRef used = input.points();
  const std::optional<Visibility> seen = seenFrom(used, viewpoint);
  PlaneInput cloud(used, seen ? &*seen : nullptr);
  if (given) cloud.normals = &*given;
  cloud.may_be_rings = may_be_rings;
  PlaneSearch search;
  if (seen) search.viewpoint = seen->viewpoint();
  search.rows = input.rows();
  const Computing computing;
  search.found = detectWithEvidence(cloud, options, evidence ? &search.evidence : nullptr);
  if (mesh && !seen) refineOnMesh(*mesh, search.found, options);
  return search;
}

/// The first index is along x, as in nibabel.
using VolumeArray = py::array_t<float, py::array::f_style | py::array::forcecast>;

/// A volume in place of points.
struct GivenVolume {
  ScalarGrid grid;
  VolumeLevels levels;
};

GivenVolume volumeOf(const VolumeArray& volume, const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                     const Eigen::Matrix3d& direction, const std::pair<double, double>& levels) {
  if (volume.ndim() != 3) throw std::invalid_argument("volume = array of another shape, must have three axes");
  const ScalarGrid::Size size{static_cast<int>(volume.shape(0)), static_cast<int>(volume.shape(1)),
                              static_cast<int>(volume.shape(2))};
  return {ScalarGrid(size, ScalarGrid::placed(spacing, origin, direction),
                     std::vector<float>(volume.data(), volume.data() + volume.size())),
          {levels.first, levels.second}};
}

PlaneSearch volumePlanes(const GivenVolume& volume, bool approximate, int max_planes, std::uint64_t seed, int threads) {
  const Computing computing;
  auto options = optionsWith<DetectionOptions>(seed, threads);
  options.approximate = approximate;
  options.max_planes = max_planes;
  PlaneSearch search;
  search.found = detectVolumePlanes(volume.grid, options, volume.levels);
  return search;
}

/// The input of a transform.
struct TransformInput {
  GaussianEdt edt;
  Eigen::Vector3d center_of_mass;
};

/// \param shape points or a volume.
/// \throws NoAnswer, and std::invalid_argument for bad options.
TransformInput transformInput(const py::object& shape, const GaussianEdtOptions& options, std::uint64_t seed) {
  if (py::isinstance<GivenVolume>(shape)) {
    const auto& volume = shape.cast<const GivenVolume&>();
    const Computing computing;
    const auto side = static_cast<std::size_t>(std::max(options.num_cells, 16));  // as in TransformAnalysis
    const VolumeFunction f(volume.grid, volume.levels, side * side * side, options.num_threads);
    return {GaussianEdt(f, options), centerOfMass(f.bodyPoints(false))};
  }
  options.validate();
  const InputPoints input("points", arrayOf("points", shape), 0, seed);
  checkAnswerable("points", input.points());
  const Computing computing;
  return {GaussianEdt(input.points(), options), centerOfMass(input.points())};
}

/// \return PRST, PRSD and GEDT.
std::vector<std::vector<float>> descriptors(const AnyArray& points, const py::object& viewpoint, bool input_axes,
                                            bool by_equation_1, std::uint64_t seed, int threads) {
  auto options = optionsWith<DescriptorOptions>(seed, threads);
  options.by_equation_1 = by_equation_1;
  options.validate();
  const InputPoints input("points", points, 20'000, seed);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  checkAnswerable("points", input.points());
  const Computing computing;
  const Eigen::Isometry3d T_frame_input = descriptorFrame(input.points(), input_axes, seen ? &*seen : nullptr, options);
  SymmetryDescriptors all = symmetryDescriptors(input.points(), T_frame_input, options);
  return {std::move(all.prst), std::move(all.prsd), std::move(all.gedt)};
}

PlaneSearch publishedPlanesOf(const AnyArray& points, const std::string& method, int num_points, std::uint64_t seed,
                              int threads) {
  const TransformMethod estimator = methodNamed(method);
  auto options = optionsWith<PublishedOptions>(seed, threads);
  options.num_points = num_points;
  options.validate();
  const InputPoints input("points", points, 0, seed);
  PlaneSearch search;
  search.found.reason = whyUnanswerable(input.points());
  if (!search.found.reason.empty()) return search;
  const Computing computing;
  const GaussianEdt edt(input.points());
  search.found.planes =
      publishedPlanes(input.points(), edt, publishedMap(input.points(), edt, estimator, seed, threads), options);
  return search;
}

std::vector<float> localSymmetryOf(const py::object& shape, const AnyArray& at, double scale, std::uint64_t seed,
                                   int threads) {
  GaussianEdtOptions edt_options;
  edt_options.num_threads = threads;
  const GaussianEdt edt = transformInput(shape, edt_options, seed).edt;
  const InputPoints asked("at", at, 0, seed);
  const Computing computing;
  auto options = optionsWith<LocalSymmetryOptions>(seed, threads);
  options.scale = scale * edt.radius();
  return localSymmetry(edt, asked.points(), options);
}

SymmetryFrame frame(const AnyArray& points, const py::object& viewpoint, std::size_t max_points, bool as_published,
                    std::uint64_t seed, int threads, const std::optional<MeshSurface>& mesh) {
  auto options = optionsWith<FrameOptions>(seed, threads);
  options.as_published = as_published;
  options.validate();
  const InputPoints input("points", points, max_points, seed);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  checkAnswerable("points", input.points());
  options.refined = !mesh || seen;  // otherwise it is refined on the mesh itself
  const Computing computing;
  SymmetryFrame found = symmetryFrame(input.points(), options, seen ? &*seen : nullptr);
  if (mesh && !seen) refineOnMesh(*mesh, found);
  return found;
}

ObjectSymmetries rotations(const AnyArray& points, const py::object& viewpoint, double tolerance,
                           double absolute_tolerance, double max_feature, std::uint64_t seed, int threads,
                           const std::optional<MeshSurface>& mesh) {
  auto options = optionsWith<ObjectSymmetryOptions>(seed, threads);
  options.tolerance = tolerance;
  options.absolute_tolerance = absolute_tolerance;
  options.max_feature = max_feature;
  options.validate();
  const InputPoints input("points", points, 0, seed);
  checkAnswerable("points", input.points());
  const bool is_scan = !mesh && seenFrom(input.points(), viewpoint);
  const Computing computing;
  ObjectSymmetries found =
      mesh ? objectSymmetries(input.points(), *mesh, options) : objectSymmetries(input.points(), options);
  if (is_scan) {
    found.support = found.confidence = 0.0;
    found.reason = "a scan from one side, must be a whole object";
  }
  return found;
}

/// \param continuous point and direction of each axis.
ObjectSymmetries rotationsOf(const std::vector<RowMajor4>& discrete,
                             const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& continuous) {
  std::vector<Eigen::Isometry3d> motions;
  for (const RowMajor4& motion : discrete) motions.push_back(motionOf("discrete", motion));
  std::vector<ContinuousSymmetry> axes;
  for (const auto& [point, direction] : continuous) axes.push_back({direction, point});
  return ObjectSymmetries::from(motions, axes);
}

/// \param by none: the plane across the view through the axis, a point and a direction, or through a point alone.
/// \return the added points, and the rows that they are the reflections of.
std::pair<py::array_t<float>, std::vector<std::size_t>> complete(
    const AnyArray& points, const std::optional<ReflectionPlane>& by,
    const std::optional<std::pair<Eigen::Vector3d, std::optional<Eigen::Vector3d>>>& axis, const py::object& viewpoint,
    int threads) {
  CompletionOptions options;
  options.num_threads = threads;
  options.validate();
  const InputPoints input("points", points, 0, 0);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  Detection found;
  if (axis && axis->second) found.axes.push_back({axis->first, *axis->second});
  if (axis && !axis->second) found.centers.push_back({axis->first});
  const ReflectionPlane plane = by ? *by : *planeAcrossView(found, seen ? seen->viewpoint() : axis->first);
  Points added;
  std::vector<std::size_t> rows;
  {
    const Computing computing;
    const PointsRef all = input.points();
    const std::vector<int> completing = completingPoints(all, plane, options, seen ? &*seen : nullptr);
    added.resize(3, completing.size());
    for (std::size_t i = 0; i < completing.size(); ++i) {
      const auto source = static_cast<std::size_t>(completing[i]);
      added.col(i) = plane.reflect(all.col(completing[i]).cast<double>()).cast<float>();
      rows.push_back(input.rows().empty() ? source : input.rows()[source]);
    }
  }
  return {toRows(added), rows};
}

/// Labels, and why the number of parts differs from the one that was set.
using Parts = std::pair<std::vector<int>, std::string>;

Parts segmentArray(const py::array& points, const SegmentationOptions& options) {
  constexpr int most_points = 30'000;  // as in SymmetrySegmentation
  checkAnswerable("points", InputPoints("points", points, most_points, options.seed).points());
  const InputPoints all("points", points, 0, options.seed);
  const Computing computing;
  const Segmentation parts = segmentCloud(all.points(), most_points, options);
  if (all.rows().empty()) return {parts.labels, parts.reason};
  std::vector<int> labels(all.numRows(), -1);
  for (std::size_t i = 0; i < all.rows().size(); ++i) labels[all.rows()[i]] = parts.labels[i];
  return {labels, parts.reason};
}

Parts segment(const AnyArray& points, const py::object& faces, int parts, const std::string& method, int depth,
              bool as_published, const std::function<void(double)>& progress, std::uint64_t seed, int threads) {
  auto options = optionsWith<SegmentationOptions>(seed, threads);
  options.num_parts = parts;
  options.method = named<SegmentationMethod>("method", method, {"merging", "splitting"});
  options.splitting.depth = depth;
  options.splitting.as_published = as_published;
  options.validate();
  if (progress)
    options.progress = [&progress](double share) {
      const py::gil_scoped_acquire acquire;
      progress(share);
    };
  if (faces.is_none()) return segmentArray(points, options);
  const InputPoints input("points", points, 0, seed);
  if (!input.usesAllRows()) throw std::invalid_argument("points: vertices not all finite, must be");
  const std::vector<std::vector<int>> polygons = polygonsOf(faces);
  const Computing computing;
  const Segmentation result = segmentSurface(meshGraph(input.points(), polygons), options);
  return {result.labels, result.reason};
}

Eigen::MatrixXf describe(const AnyArray& points, const py::object& viewpoint, std::uint64_t seed, int threads) {
  checkNumThreads(threads);
  const InputPoints input("points", points, 0, seed);
  const std::optional<Visibility> seen = seenFrom(input.points(), viewpoint);
  checkAnswerable("points", input.points());
  const Computing computing;
  const auto options = optionsWith<DescriptionOptions>(seed, threads);
  return describeShape(input.points(), options, seen ? &*seen : nullptr).signatures.transpose();
}

SymmetryMap transform(const py::object& shape, const std::array<int, 3>& bins, const std::string& method,
                      const Eigen::Vector3d& center, double radius, double sigma, int cells, std::int64_t samples,
                      double refined_share, bool as_published, std::uint64_t seed, int threads) {
  PlanarTransformOptions options;
  options.method = methodNamed(method);
  if (samples != 0) options.voting.num_pairs = samples;
  if (samples != 0) options.sampled.num_samples = static_cast<int>(std::min<std::int64_t>(samples, 10'000'000));
  options.rotational.refined_share = refined_share;
  if (as_published) options.voting.near_distance = 0.0;
  options.setSeed(seed);
  options.setNumThreads(threads);
  options.validate();
  const MapSize size{bins[0], bins[1], bins[2]};
  size.validate();
  const TransformInput input = transformInput(shape, {cells, sigma, threads, radius, center}, seed);
  const Computing computing;
  const PlaneGrid grid(size, input.edt.center(), input.edt.radius());
  return planarTransform(input.edt, grid, input.center_of_mass, options);
}

/// \return for each row, the row of its counterpart, -1 for none, and the distance of the counterpart from the
/// reflection.
std::pair<py::array_t<std::int64_t>, py::array_t<double>> pairs(const AnyArray& points, const ReflectionPlane& plane,
                                                                double max_distance) {
  const InputPoints input("points", points, 0, 0);
  ReflectedPairs found;
  {
    const Computing computing;
    found = reflectedPairs(input.points(), plane, max_distance);
  }
  std::vector<std::int64_t> index(input.numRows(), -1);
  std::vector<double> distance(index.size(), std::numeric_limits<double>::infinity());
  const auto row = [&](std::size_t i) { return input.rows().empty() ? i : input.rows()[i]; };
  for (std::size_t i = 0; i < found.index.size(); ++i) {
    if (found.index[i] < 0) continue;
    index[row(i)] = static_cast<std::int64_t>(row(static_cast<std::size_t>(found.index[i])));
    distance[row(i)] = std::sqrt(found.sq_distances[i]);
  }
  return {toArray(index), toArray(distance)};
}

std::string whyNotSeen(const AnyArray& points, const Eigen::Vector3d& viewpoint) {
  const InputPoints input("points", points, 0, 0);
  const Computing computing;
  return input.points().cols() == 0 || !viewpoint.allFinite() ? "" : whyNotSeenFrom(input.points(), viewpoint);
}

}  // namespace

PYBIND11_MODULE(_pcl_symmetry, module) {
  addComputing(module);
  py::register_exception<NoAnswer>(module, "NoAnswer");
  py::class_<Visibility>(module, "Visibility").def_property_readonly("viewpoint", &Visibility::viewpoint);
  py::class_<StoredViewpoint>(module, "StoredViewpoint").def(py::init([](const Eigen::Vector3d& position) {
    return StoredViewpoint{position};
  }));
  addEvidence(module);
  py::class_<MeshSurface>(module, "MeshSurface").def(py::init(&meshSurface));
  addResults(module);
  add(module, "planes", &planes, "points", "viewpoint", "tolerance", "absolute_tolerance", "min_confidence",
      "approximate", "max_planes", "normals", "max_points", "evidence", "seed", "threads", "mesh", "may_be_rings");
  py::class_<GivenVolume>(module, "Volume");
  add(module, "volume", &volumeOf, "volume", "spacing", "origin", "direction", "levels");
  add(module, "volume_planes", &volumePlanes, "volume", "approximate", "max_planes", "seed", "threads");
  add(module, "published_planes", &publishedPlanesOf, "points", "method", "num_points", "seed", "threads");
  add(module, "frame", &frame, "points", "viewpoint", "max_points", "as_published", "seed", "threads", "mesh");
  add(module, "rotations", &rotations, "points", "viewpoint", "tolerance", "absolute_tolerance", "max_feature", "seed",
      "threads", "mesh");
  add(module, "rotations_of", &rotationsOf, "discrete", "continuous");
  add(module, "transform", &transform, "shape", "bins", "method", "center", "radius", "sigma", "cells", "samples",
      "refined_share", "as_published", "seed", "threads");
  add(module, "local_symmetry", &localSymmetryOf, "shape", "at", "scale", "seed", "threads");
  add(module, "descriptors", &descriptors, "points", "viewpoint", "input_axes", "by_equation_1", "seed", "threads");
  add(module, "describe", &describe, "points", "viewpoint", "seed", "threads");
  add(module, "segment", &segment, "points", "faces", "parts", "method", "depth", "as_published", "progress", "seed",
      "threads");
  add(module, "complete", &complete, "points", "plane", "axis", "viewpoint", "threads");
  add(module, "symmetrize", &symmetrize, "points", "faces", "plane", "half", "threads");
  add(module, "mirrored_half", &mirroredHalfOf, "vertices", "faces", "plane", "left");
  add(module, "profile", &revolutionProfileOf, "points", "point", "direction", "num_points");
  add(module, "sample_mesh", &sampleMesh, "vertices", "faces", "num_points", "seed");
  add(module, "pairs", &pairs, "points", "plane", "max_distance");
  add(module, "why_not_seen_from", &whyNotSeen, "points", "viewpoint");
  module.attr("__version__") = PCL_SYMMETRY_VERSION;
}

}  // namespace pcl_symmetry::python
