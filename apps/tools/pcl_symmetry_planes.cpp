/// Symmetry planes of a cloud or mesh: a table, JSON, the support of every point, a picture.
#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/core/revolution_profile.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/planar_symmetry_transform.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pictures/raster_image.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct PlanesOptions {
  BatchOptions batch;
  std::optional<std::string> png_path, html_path, support_path, profile_path;
  DetectionOptions detection;
  std::optional<double> tolerance;
  std::string method = "sampled";
  bool method_given = false, as_published = false, explain = false;
  std::optional<Eigen::Vector4d> ground;
  std::optional<Eigen::Vector3d> up;
  std::optional<int> label;
  CommonOptions common;
};

/// One row per plane, axis or center; cells that do not apply are empty.
const std::vector<std::string> kColumns = {"number",     "kind",  "a",       "b",     "c",    "d",
                                           "x",          "y",     "z",       "dx",    "dy",   "dz",
                                           "confidence", "share", "support", "score", "seen", "deviation"};

CommandLine commandLine(PlanesOptions& options) {
  CommandLine line("pcl_symmetry_planes", "Finds the planes of symmetry of clouds, meshes and volumes.",
                   "pcl_symmetry_planes chair.pcd -json planes.json -png planes.png");
  options.batch.outputs = {&options.png_path, &options.html_path, &options.support_path, &options.profile_path};
  line.positionals("input", options.batch.inputs, kManyInputs + std::string("; volumes (") + kVolumeFiles + ")")
      .text("png", "FILE.png", options.png_path,
            "picture: cloud, planes and support, best planes first; three slices of a volume and its asymmetry")
      .text("html", "FILE.html", options.html_path,
            "page with the same in three dimensions, for any browser, without network")
      .direction("up", options.up,
                 "direction that is up in the picture, input frame (0,0,1; for a camera at 0 0 0 0,-1,0)")
      .text("support", "FILE", options.support_path,
            "cloud with one more field per plane, support_1, support_2 ...: how well the point supports the plane, NaN "
            "where that was not seen")
      .text(
          "profile", "FILE", options.profile_path,
          "profile of a body of revolution, .csv or .svg: radius, height, spread and number of points along the curve "
          "that gives the body when it is rotated about the best axis")
      .flag("approximate", options.detection.approximate,
            "also report approximate symmetries and symmetries of parts, marked as such")
      .number("min_confidence", options.detection.min_confidence, Range::closed(0, 1),
              "least probability of a plane that is called a symmetry")
      .number(
          "tolerance", options.tolerance, Range::upTo(0, 0.1),
          "how far a symmetric surface may be off, as a share of the greatest distance between two points (default: "
          "0.01, or what a depth camera resolves, up to 0.03)")
      .number("absolute_tolerance", options.detection.absolute_tolerance, Range::atLeast(0),
              "the same in input units; 0 = -tolerance decides")
      .choice("method", options.method, kMethodNames,
              "the estimator of the map (Sections 4.2 and 4.3); with -as_published convolution")
      .flag("as_published", options.as_published,
            "refine the maxima of the map as the paper does (Section 4.4), without a decision")
      .flag("explain", options.explain,
            "also print why each plane, axis and center has its confidence, and planes their kind")
      .plane("ground", options.ground,
             "what the object stands on: a x + b y + c z + d = 0; with a viewpoint, sparse points of a LiDAR are then "
             "decided by the box around them")
      .number(
          "label", options.label, Range::atLeast(0),
          "the object is the points of a cloud whose field label has this value; the others are its scene: they hide "
          "it, and it stands on them")
      .number("max_planes", options.detection.max_planes, Range::closed(1, 1000), "largest number of planes reported")
      .common(options.common, kShapeFlags | kSigma | kVolumes);
  options.batch.addTo(line);
  return line;
}

/// The findings, best first, in the frame of the shifted points. Its rotations have orders from 2 on, and at least the
/// confidence of a symmetry.
struct Findings : Detection {
  ViewpointSource viewpoint_source = ViewpointSource::None;
  std::optional<Eigen::Vector3d> viewpoint;  ///< viewpoint used
  std::size_t num_points = 0;                ///< number of points used
  std::vector<std::vector<float>> support;   ///< support for each plane at every point; empty if no output shows it

  bool empty() const { return planes.empty() && axes.empty() && centers.empty() && rotations.empty(); }
  bool hasSymmetry() const {
    const auto is_symmetry = [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; };
    return !axes.empty() || !centers.empty() || !rotations.empty() ||
           std::any_of(planes.begin(), planes.end(), is_symmetry);
  }
};

std::string coefficientsOf(const ReflectionPlane& plane, const Eigen::Vector3d& shift) {
  const Eigen::Vector4d c = printedCoefficients(plane, shift);
  return formatted("%.6f %.6f %.6f %.*g", c[0], c[1], c[2], lengthDigits(shift), c[3]);
}

/// \return a number of the table; "-" if it was not measured.
std::string measured(double number) {
  return std::isnan(number) ? "-" : formatted("%.3f", number);
}

std::string lineOfTolerance(const Findings& findings) {
  const double share = 100.0 * findings.tolerance / findings.diameter;
  if (findings.tolerance >= findings.resolution)
    return formatted("decided at %.1f %% of the diameter; the points resolve no less\n", share);
  return formatted("decided at %.1f %% of the diameter; the points resolve %.1f %%\n", share,
                   100.0 * findings.resolution / findings.diameter);
}

std::string tableOf(const Findings& findings, const Eigen::Vector3d& shift) {
  const int digits = lengthDigits(shift);
  std::string table;
  if (findings.num_stray_points > 0)
    table += counted(findings.num_stray_points, "stray point") + " left out, far from all others\n";
  if (findings.flat)
    table += "flat: the points lie on the plane " + coefficientsOf(*findings.flat, shift) +
             "; a reflection across it is uninformative\n";
  if (findings.resolution >= findings.tolerance && findings.tolerance > 0.0) table += lineOfTolerance(findings);
  if (findings.empty()) {
    table += "no symmetry plane\n";
    if (const auto& best = findings.best)  // its deviation from a symmetry
      table += "best plane " + coefficientsOf(*best, shift) +
               (std::isnan(best->share)  // for a volume
                    ? formatted(", confidence %.3f\n", best->confidence)
                    : formatted(" maps %.1f %% of the surface to within %.3g, 97 %% to within %.3g\n",
                                100.0 * best->share, findings.tolerance, best->deviation));
    if (findings.undecided)
      table += formatted("the points leave it open: the share of the whole surface is between %.0f and %.0f %%\n",
                         100.0 * findings.best->share_low, 100.0 * findings.best->share_high);
    return table;
  }
  for (const SymmetryCenter& center : findings.centers)
    table += formatted("center of all planes: %s, confidence %.3f\n",
                       spelled(shiftedBack(center.point, shift), digits).c_str(), center.confidence);
  for (const SymmetryAxis& axis : findings.axes) table += lineOf(axis, 0, shift);
  for (const SymmetryRotation& rotation : findings.rotations) table += lineOf(rotation, rotation.fold, shift);
  const std::vector<SymmetryPlane>& planes = findings.planes;
  if (planes.empty()) return table;
  table += formatted("%5s %10s %10s %10s %12s %10s %7s %7s %7s %6s  %s\n", "plane", "a", "b", "c", "d", "confidence",
                     "share", "support", "score", "seen", "kind");
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector4d c = printedCoefficients(planes[i], shift);
    table += formatted("%5zu %10.6f %10.6f %10.6f %12.*g %10s %7s %7.3f %7.3f %6.3f  %s\n", i + 1, c[0], c[1], c[2],
                       digits, c[3], measured(planes[i].reasons.empty() ? std::nan("") : planes[i].confidence).c_str(),
                       measured(planes[i].share).c_str(), planes[i].support, planes[i].score, planes[i].seen,
                       toString(planes[i].kind));
  }
  return table;
}

nlohmann::json describe(const SymmetryAxis& axis, const Eigen::Vector3d& shift) {
  nlohmann::json json = axisJson(axis, shift);
  json.update({{"score", axis.score}, {"support", axis.support}});
  return json;
}

nlohmann::json describe(const SymmetryCenter& center, const Eigen::Vector3d& shift) {
  return {{"point", numbersOf(shiftedBack(center.point, shift))},
          {"confidence", center.confidence},
          {"score", center.score},
          {"support", center.support}};
}

Rows rowsOf(const Findings& findings, const Eigen::Vector3d& shift) {
  Rows rows;
  const auto add = [&](std::size_t number, const char* kind, const nlohmann::json& found) {
    std::vector<nlohmann::json> row{number, kind};
    for (const auto& [name, size] : {std::pair("coefficients", 4), std::pair("point", 3), std::pair("direction", 3)})
      for (int k = 0; k < size; ++k) row.push_back(found.contains(name) ? found[name][k] : nlohmann::json());
    for (const char* const name : {"confidence", "share", "support", "score", "seen", "deviation"})
      row.push_back(found.value(name, nlohmann::json()));
    rows.push_back(row);
  };
  std::size_t planes = 0, axes = 0, rotations = 0, centers = 0;
  for (const SymmetryPlane& plane : findings.planes) add(++planes, toString(plane.kind), planeJson(plane, shift));
  for (const SymmetryAxis& axis : findings.axes) add(++axes, "axis", describe(axis, shift));
  for (const SymmetryRotation& rotation : findings.rotations) add(++rotations, "rotation", axisJson(rotation, shift));
  for (const SymmetryCenter& center : findings.centers) add(++centers, "center", describe(center, shift));
  if (findings.best) add(1, findings.undecided ? "undecided" : "best", planeJson(*findings.best, shift));
  return rows;
}

nlohmann::json describe(const InputShape& input, const Findings& findings) {
  const Eigen::Vector3d& shift = input.shift();
  nlohmann::json json{
      {"file", input.path},
      {"num_points", findings.num_points},
      {"stray_points", findings.num_stray_points},
      {"partial", findings.viewpoint.has_value()},
      {"undecided", findings.undecided},
      {"viewpoint", {{"from", toString(findings.viewpoint_source)}}},
      {"tolerance", findings.tolerance},
      {"resolution", findings.resolution},
      {"planes", planesJson(findings.planes, shift)},
      {"axes", listOf(findings.axes, [&](const auto& axis) { return describe(axis, shift); })},
      {"centers", listOf(findings.centers, [&](const auto& center) { return describe(center, shift); })},
      {"timing_ms", timingJson(findings.timing_ms)}};
  if (findings.viewpoint) json["viewpoint"]["position"] = numbersOf(shiftedBack(*findings.viewpoint, shift));
  if (findings.best) json["best"] = planeJson(*findings.best, shift);
  if (findings.flat) json["flat"] = {{"coefficients", numbersOf(*findings.flat, shift)}};
  if (findings.viewpoint) json["rotations"] = rotationsJson(findings.rotations, shift);
  return json;
}

std::vector<PicturePanel> panelsOf(const Findings& findings) {
  constexpr std::size_t kMostPanels = 9;
  std::vector<PicturePanel> panels;
  const auto add = [&](const std::string& label) -> PicturePanel& {
    panels.emplace_back().label = label;
    return panels.back();
  };
  for (const SymmetryAxis& axis : findings.axes)
    add(formatted("axis of revolution: confidence %.2f", axis.confidence)).axes = {{axis.point, axis.direction}};
  for (const SymmetryRotation& rotation : findings.rotations)
    add(formatted("axis of order %d: confidence %.2f", rotation.fold, rotation.confidence)).axes = {
        {rotation.point, rotation.direction}};
  for (const SymmetryCenter& center : findings.centers) {
    PicturePanel& panel = add(formatted("every plane through the center: confidence %.2f", center.confidence));
    for (int k = 0; k < 3; ++k) panel.axes.push_back({center.point, Eigen::Vector3d::Unit(k)});
  }
  for (std::size_t k = 0; k < findings.planes.size() && panels.size() < kMostPanels; ++k) {
    const SymmetryPlane& plane = findings.planes[k];
    const std::string judged = plane.reasons.empty() ? "" : formatted("confidence %.2f, ", plane.confidence),
                      where = findings.viewpoint ? formatted(" of %.0f %% seen", 100.0 * plane.seen) : "";
    PicturePanel& panel = add(formatted("plane %zu (%s): %ssupport %.2f%s", k + 1, toString(plane.kind), judged.c_str(),
                                        plane.support, where.c_str()));
    panel.support.assign(findings.support[k].begin(), findings.support[k].end());
    panel.planes = {{plane.normal(), plane.offset(), Eigen::Vector3d::Zero(), 0.0, distinctColor(k)}};
    if (findings.viewpoint) panel.legend = {{kUnseenSegment, "not seen"}};
  }
  if (panels.empty()) panels.push_back({"no symmetry plane"});
  return panels;
}

PictureScene makeScene(const Cloud::ConstPtr& cloud, const Findings& findings,
                       const std::optional<Eigen::Vector3d>& given_up) {
  PictureScene scene{cloud, std::nullopt, panelsOf(findings)};
  const Eigen::Vector3d middle = finitePoints(*cloud).rowwise().mean().cast<double>();
  const Eigen::Vector3d up = given_up.value_or(upFor(findings.viewpoint, middle));
  if (given_up) standUpright(scene, up);
  if (findings.planes.empty() && !findings.viewpoint) return scene;
  // Off the normals of the planes shown, so that none is seen edge on or face on, and from the side of the scanner or
  // from above; see ViewpointSelection for more.
  Eigen::Vector3d toward = Eigen::Vector3d::Zero();
  if (findings.viewpoint) toward = *findings.viewpoint - middle;
  const Eigen::Vector3d n = findings.planes.empty() ? toward.normalized() : findings.planes[0].normal();
  Eigen::Vector3d across = up - n.dot(up) * n;
  const bool is_level = across.norm() < 0.3;
  if (is_level && !findings.viewpoint) toward = up;
  across = is_level ? n.unitOrthogonal() : across.normalized();
  scene.view = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& by : {Eigen::Vector3d(0.75 * n), n.cross(across), Eigen::Vector3d(0.55 * across)})
    scene.view += by.dot(toward) < 0.0 ? Eigen::Vector3d(-by) : by;
  scene.up = is_level ? up : given_up.value_or(across);
  return scene;
}

/// Passes to the refinement a map by the given estimator: of 64 x 64 x 64 bins as published, otherwise as fine as the
/// refinement's own map.
void giveMap(SymmetryMaximaRefinement<pcl::PointXYZ>& refinement, const InputShape& input,
             const PlanesOptions& options) {
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  const DetectionOptions& detection = refinement.getOptions();
  transform.setNumCells(detection.num_cells);
  transform.setSigma(detection.sigma);
  if (!options.as_published)
    transform.setMapSize(detection.expert.num_theta, detection.expert.num_phi, detection.expert.num_radius);
  transform.setMethod(methodNamed(options.method));
  transform.setRandomSeed(detection.seed);
  transform.setNumberOfThreads(detection.num_threads);
  transform.setViewpoint(refinement.getViewpoint());
  transform.setMaxPoints(50'000);
  transform.setInputCloud(input.points);
  const SymmetryMap map = transform.compute();
  if (transform.getReason().empty()) refinement.setSymmetryMap(map, transform.getDistanceTransform());
}

Findings search(const FileJob& job, const InputShape& input, const PlanesOptions& options) {
  Step searching(job.console, "Searching planes");
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  Findings findings;
  namingFile(input.path, [&] {
    DetectionOptions detection = options.detection;
    job.common.applyTo(detection);
    refinement.setOptions(detection);
    if (options.tolerance) refinement.setTolerance(*options.tolerance);
    refinement.setAsPublished(options.as_published);
    if (options.ground) refinement.setGround(shifted(*options.ground, input.shift()));
    setInput(refinement, input, job.common);
    if (options.label)
      refinement.setIndices(pcl::make_shared<pcl::Indices>(labeledPoints(input.shape.cloud, *options.label)));
    if (input.shape.mesh) refinement.setMesh(meshSurface(*input.shape.mesh));
    if (options.method_given && !input.volume) giveMap(refinement, input, options);
    checked(refinement, input, refinement.compute());
  });
  static_cast<Detection&>(findings) = refinement.getDetection();
  const auto is_other = [&](const SymmetryRotation& rotation) {  // rotations by any angle are among the axes
    return rotation.fold == 0 || rotation.confidence < options.detection.min_confidence;
  };
  findings.rotations.erase(std::remove_if(findings.rotations.begin(), findings.rotations.end(), is_other),
                           findings.rotations.end());
  findings.viewpoint_source = refinement.getViewpointSource();
  findings.viewpoint = refinement.getUsedViewpoint();
  findings.num_points = refinement.getUsedIndices().size();
  std::string summary = counted(findings.planes.size(), "plane");
  if (!findings.axes.empty()) summary += ", " + counted(findings.axes.size(), "axis", "axes");
  if (findings.viewpoint)
    summary += std::string(", seen from one side, viewpoint ") + toString(findings.viewpoint_source);
  const double searching_ms = searching.done(summary);
  findings.timing_ms.emplace_back("load", input.loading_ms);
  findings.timing_ms.emplace_back("total", searching_ms);
  if (!input.volume && (options.support_path || options.png_path || options.html_path))
    findings.support =
        refinement.computePointSupport(std::vector<ReflectionPlane>(findings.planes.begin(), findings.planes.end()));
  return findings;
}

void saveSupport(const InputShape& input, const Findings& findings, const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < findings.support.size(); ++k) names.push_back("support_" + std::to_string(k + 1));
  saveCloud(path, withFields(input.fields(), names, findings.support), input.shape.sensor_origin,
            input.shape.sensor_orientation);
}

/// A drawing of the profile: the curve and its spread on one side of the axis, only the curve on the other.
std::string profileSvg(const std::vector<ProfilePoint>& profile) {
  double width = 0.0, low = profile.front().height, high = low;
  for (const ProfilePoint& point : profile) {
    width = std::max(width, point.radius + point.spread);
    low = std::min(low, point.height);
    high = std::max(high, point.height);
  }
  constexpr double kMargin = 0.05, kPixels = 800.0, kLine = 0.003;
  const double extent = std::max(2.0 * width, high - low), border = kMargin * extent,
               height = high - low + 2.0 * border;
  const double all = 2.0 * (width + border), scale = kPixels / std::max(all, height);
  std::string dots;
  for (const ProfilePoint& point : profile)
    for (const double side : {-1.0, 1.0})
      dots += formatted("<circle cx=\"%.6g\" cy=\"%.6g\" r=\"%.4g\" fill=\"%s\" fill-opacity=\"%s\"/>\n",
                        side * point.radius, -point.height, std::max(kLine * extent, side > 0.0 ? point.spread : 0.0),
                        side > 0.0 ? "#e69f00" : "#0072b2", side > 0.0 ? "0.3" : "1");
  return formatted(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"%.6g %.6g %.6g "
             "%.6g\">\n",
             scale * all, scale * height, -width - border, -high - border, all, height) +
         formatted("<path d=\"M 0 %.6g V %.6g\" stroke=\"#595959\" stroke-width=\"%.4g\"/>\n", -high - border,
                   -low + border, kLine * extent) +
         dots + "</svg>\n";
}

void saveProfile(const InputShape& input, const Findings& findings, const std::string& path) {
  if (findings.axes.empty()) throw InputError(input.path + ": is no body of revolution, has no profile");
  const std::vector<ProfilePoint> profile =
      namingFile(input.path, [&] { return revolutionProfile(finitePoints(*input.points), findings.axes.front()); });
  if (profile.empty()) throw InputError(input.path + ": has too few points along its profile");
  if (boost::iends_with(path, ".svg")) return writeText(path, profileSvg(profile));
  std::string table = csvLine({"radius", "height", "spread", "count"});
  for (const ProfilePoint& point : profile) table += csvLine({point.radius, point.height, point.spread, point.count});
  writeText(path, table);
}

const Eigen::Vector3d kBrighter(0.90, 0.62, 0.0), kDarker(0.0, 0.45, 0.70);  // color-blind readers distinguish them
const Eigen::Vector3d kLine(0.84, 0.37, 0.0);
constexpr double kFullColor = 0.3;  // difference of f at which the color is full

/// A volume that is sampled at points of the input frame.
struct SlicedVolume {
  VolumeFunction function;
  Eigen::Affine3d T_index_input;
  Eigen::Vector3d middle;
  double extent;

  SlicedVolume(const ScalarGrid& volume, const VolumeLevels& levels)
      : function(volume, levels, std::size_t{1} << 23), T_index_input(function.f.T_input_index().inverse()) {
    const Points body = function.bodyPoints(false);
    const Eigen::Vector3d low = body.rowwise().minCoeff().cast<double>(),
                          high = body.rowwise().maxCoeff().cast<double>();
    middle = 0.5 * (low + high);
    extent = 1.15 * (high - low).maxCoeff();
  }

  std::optional<double> at(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = T_index_input * x;
    return function.f.contains(p) ? std::optional<double>(function.f.at(p)) : std::nullopt;
  }
};

RasterImage drawSlice(const SlicedVolume& volume, int axis, const std::optional<ReflectionPlane>& plane, bool compared,
                      int size) {
  const int across = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
  const double step = volume.extent / size;
  RasterImage image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      Eigen::Vector3d at = volume.middle;
      at[across] += (x + 0.5 - 0.5 * size) * step;
      at[up] -= (y + 0.5 - 0.5 * size) * step;
      const double own = volume.at(at).value_or(0.0);
      Eigen::Vector3d color = Eigen::Vector3d::Constant(own);
      if (compared) {
        const std::optional<double> other = volume.at(plane->reflect(at));
        const double difference = other ? own - *other : 0.0, share = std::min(1.0, std::abs(difference) / kFullColor);
        color = (1.0 - share) * Eigen::Vector3d::Constant(1.0 - 0.35 * own) +
                share * (difference > 0.0 ? kBrighter : kDarker);
      }
      if (plane) {
        const double in_slice = std::hypot(plane->normal()[across], plane->normal()[up]);
        if (in_slice > 0.05 && std::abs(plane->signedDistance(at)) < 0.8 * step * in_slice) color = kLine;
      }
      image.set(x, y, color);
    }
  return image;
}

/// Three slices through the middle of the body, seen along z, x and y of the input frame, with the line of the plane;
/// below them the same with the asymmetry f(x) - f(gamma x) in color: orange where a voxel is brighter than its
/// reflection, blue where it is darker. Without a plane, only the upper row.
/// \param size edge of each slice, pixels.
RasterImage drawVolumeSlices(const ScalarGrid& volume, const VolumeLevels& levels,
                             const std::optional<ReflectionPlane>& plane, int size) {
  const SlicedVolume sliced(volume, levels);
  std::vector<RasterImage> slices;
  for (const bool compared : {false, true})
    for (const int axis : {2, 0, 1})
      if (plane || !compared) slices.push_back(drawSlice(sliced, axis, plane, compared, size));
  return sideBySide(slices, 3);
}

void draw(const Console& console, const InputShape& input, const Findings& findings,
          const std::optional<Eigen::Vector3d>& up, const std::string& path) {
  Step drawing(console, "Drawing " + path);
  if (input.volume) {
    std::optional<ReflectionPlane> plane;
    if (!findings.planes.empty()) plane = findings.planes[0];
    writeImage(drawVolumeSlices(*input.volume, input.levels, plane, 400), path);
  } else {
    const PictureScene scene = makeScene(input.points, findings, up);
    renderPicture({scene}, path, scene.panels.size() > 1 ? 1400 : 800, scene.panels.size() > 2 ? 1100 : 600);
  }
  drawing.done();
}

void analyze(const PlanesOptions& options, FileJob& job) {
  const InputShape input = loadInput(job.console, job.path, options.common);
  if (input.volume && (options.support_path || options.html_path))
    throw InputError(job.path + ": -support and -html are of points; -surface VALUE makes some");
  const std::pair<bool, const char*> of_points[]{
      {options.as_published, "-as_published"},
      {options.method_given, "-method"},
      {options.tolerance.has_value(), "-tolerance"},
      {options.detection.absolute_tolerance > 0.0, "-absolute_tolerance"},
      {options.ground.has_value(), "-ground"},
      {options.up.has_value(), "-up"},
      {options.common.viewpoint.mode != Viewpoint::Mode::Auto, "-viewpoint"}};
  for (const auto& [is_given, flag] : of_points)
    if (input.volume && is_given) throw InputError(job.path + ": " + flag + " is of points, not of volumes");
  if (options.label && (input.volume || input.shape.mesh))
    throw InputError(job.path + ": -label needs a cloud with a field label");
  const Findings findings = search(job, input, options);
  if (options.ground && !findings.viewpoint)
    job.console.warn(input.path + ": -ground has no effect without a viewpoint (-viewpoint)");
  if (findings.viewpoint && !findings.hasSymmetry() && input.points->isOrganized() && !options.label)
    job.console.warn(input.path + ": if this is a whole frame, pcl_symmetry_scene finds its objects");
  const std::string table = tableOf(findings, input.shift()) + (options.explain ? explained(findings) : "");
  job.report({table, describe(input, findings), rowsOf(findings, input.shift())});
  if (options.support_path) saveSupport(input, findings, job.output(*options.support_path));
  if (options.png_path) draw(job.console, input, findings, options.up, job.output(*options.png_path));
  if (options.html_path)
    writePage(makeScene(input.points, findings, options.up), {job.path, table}, job.output(*options.html_path));
  // Not all shapes have a profile.
  if (options.profile_path) saveProfile(input, findings, job.output(*options.profile_path));
}

int run(int argc, char** argv) {
  PlanesOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  options.method_given = line.given("method");
  line.goWith("the decision, which -as_published leaves out", !options.as_published,
              {"explain", "approximate", "min_confidence", "tolerance", "absolute_tolerance", "ground", "profile"});
  line.goWith("the decision, which -as_published without -method leaves out",
              !options.as_published || options.method_given, {"viewpoint"});
  line.goWith("a viewpoint, which -viewpoint none takes away", options.common.viewpoint.mode != Viewpoint::Mode::None,
              {"ground"});
  line.goWith("-png or -html", options.png_path || options.html_path, {"up"});
  line.goWith("-absolute_tolerance 0", options.detection.absolute_tolerance == 0.0, {"tolerance"});
  options.detection.min_possible = std::min(options.detection.min_possible, options.detection.min_confidence);
  if (options.support_path) checkCloudExtension(*options.support_path);
  if (options.profile_path && !boost::iends_with(*options.profile_path, ".csv") &&
      !boost::iends_with(*options.profile_path, ".svg"))
    throw UsageError(*options.profile_path + ": extension must be .csv or .svg");
  return runOnFiles(options.batch, options.common, kColumns, [&](FileJob& job) { analyze(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
