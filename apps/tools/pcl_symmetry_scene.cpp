/// The objects of one frame of a sensor and their symmetries: a table, JSON, the completed scene, a picture, a page.
#include <pcl/common/io.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>

#include "command_line/run_on_files.h"
#include "core/geometry/directions.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/load_module.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_scene.h"
#include "pictures/drawing.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SceneToolOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, database_path, png_path, html_path;
  bool no_frames = false, no_completion = false, no_separation = false, explain = false;
  std::optional<Eigen::Vector4d> ground;
  std::optional<std::string> intrinsics;
  double depth_scale = 1000.0;
  SceneOptions scene;
  CommonOptions common;
};

CommandLine commandLine(SceneToolOptions& o) {
  CommandLine line(
      "pcl_symmetry_scene",
      "Finds the objects of a frame of a depth camera or scanner, and their symmetries. A cloud of one object alone "
      "would be taken apart: pcl_symmetry_planes takes it as a whole.",
      "pcl_symmetry_scene table.pcd completed.pcd -json objects.json -png objects.png");
  o.batch.outputs = {&o.output, &o.png_path, &o.html_path};
  line.positional("input", o.input,
                  ".pcd or .ply: organized, or with the viewpoint of the sensor; .png: a depth image of 16 bits, with "
                  "-intrinsics; - for standard input, or many: a folder, a "
                  "pattern in quotes, a list @FILE")
      .positional(
          "output", o.output,
          "completed scene, .pcd or .ply, with the fields object (-1 = supporting plane, 0 = none) and completed")
      .text("database", "FILE", o.database_path, "names objects by the models of this file of pcl_symmetry_database")
      .text("png", "FILE.png", o.png_path, "picture: the scene, and each object with what its symmetry adds")
      .text("html", "FILE.html", o.html_path, "page that shows the scene, its objects, planes and axes in any browser")
      .text("intrinsics", "FX,FY,CX,CY", o.intrinsics, "of the camera of a depth image, pixels")
      .number("depth_scale", o.depth_scale, Range::above(0), "values of a depth image for each unit of length")
      .plane("ground", o.ground,
             "what the objects stand on, a x + b y + c z + d = 0, in place of supporting planes that are searched for")
      .number("max_range", o.scene.max_range, Range::atLeast(0),
              "points farther from the sensor are left out, input units; 0 = no limit")
      .number("plane_distance", o.scene.plane_distance, Range::atLeast(0),
              "distance of points that belong to a supporting plane, input units; 0 = from the points")
      .number("cluster_distance", o.scene.cluster_distance, Range::atLeast(0),
              "distance between points of one object, input units; 0 = from the points")
      .number("min_points", o.scene.min_points, Range::closed(20, 1'000'000'000), "least number of points of an object")
      .number("max_points", o.scene.max_points, Range::closed(100, 1'000'000'000),
              "points of an object that are analyzed")
      .number("accept", o.scene.recognition.min_confidence, Range::closed(0, 1),
              "with -database: least confidence of a name that is accepted")
      .number("min_confidence", o.scene.detection.min_confidence, Range::closed(0, 1),
              "least probability of a plane that is called a symmetry")
      .flag("explain", o.explain, "also print why each plane, axis and center of the objects has its confidence")
      .flag("no_separation", o.no_separation, "leaves objects that touch together")
      .flag("no_frames", o.no_frames, "leaves the frames of the objects out")
      .flag("no_completion", o.no_completion, "leaves the completion of the objects out")
      .common(o.common, kAnalysisFlags);
  o.batch.addTo(line);
  return line;
}

constexpr std::size_t kDrawnPoints = 150'000;         // points of the overview
constexpr std::size_t kMostPanels = 8;                // greatest number of objects that have a panel of their own
constexpr int kPanelWidth = 520, kPanelHeight = 440;  // pixels
constexpr int kAddedColor = 5;  // color of points that a symmetry added, relative to the color of the object
// Height of the camera above the line of sight, as a share of the distance: a slightly raised view shows depths.
constexpr double kRaised = 0.25;
constexpr double kAside = 1.1;  // angle around an object that was completed, radians

constexpr double kAxisReach = 1.4, kPlaneReach = 1.1;  // radii of the object

std::size_t numPlanes(const SceneObject& object, PlaneKind kind) {
  return static_cast<std::size_t>(std::count_if(object.planes.begin(), object.planes.end(),
                                                [&](const SymmetryPlane& plane) { return plane.kind == kind; }));
}

std::string summaryOf(const SceneObject& object) {
  const auto sure = [](const std::string& what, double confidence) {
    return what + formatted(", confidence %.2f", confidence);
  };
  const std::size_t num_possible = numPlanes(object, PlaneKind::Possible);
  std::string text = num_possible > 0 ? counted(num_possible, "possible plane") : "no symmetry";
  if (!object.reason.empty())
    text = object.reason;
  else if (!object.centers.empty())
    text = sure("sphere", object.centers.front().confidence);
  else if (!object.axes.empty())
    text = sure("axis of revolution", object.axes.front().confidence);
  else if (!object.planes.empty() && object.planes.front().kind == PlaneKind::Symmetry)
    text = sure(counted(numPlanes(object, PlaneKind::Symmetry), "plane"), object.planes.front().confidence);
  if (!object.models.empty())
    text += ", " + object.models.front().name + formatted(" (%.2f)", object.models.front().confidence);
  else if (!object.model_reason.empty())
    text += ", no model fits" + (object.reason.empty() ? ": " + object.model_reason : "");
  return text;
}

std::string toleranceOf(const SceneObject& object) {
  if (!(object.diameter > 0.0)) return "";
  const auto share = [&](double length) { return 100.0 * length / object.diameter; };
  std::string text = formatted("decided at %.1f %% of the diameter", share(object.tolerance));
  if (object.resolution > 0.0) text += formatted(", the points resolve %.1f %%", share(object.resolution));
  return text;
}

nlohmann::json describeObject(const SceneObject& object, const Eigen::Vector3d& shift) {
  const auto centerJson = [&](const SymmetryCenter& center) -> nlohmann::json {
    return {{"point", numbersOf(shiftedBack(center.point, shift))}, {"confidence", center.confidence}};
  };
  const auto modelJson = [&](const RecognizedModel& model) -> nlohmann::json {
    return {{"name", model.name},
            {"confidence", model.confidence},
            {"merit", model.score.merit()},
            {"T_model_scene", rowMajor(shiftedBack(model.T_model_scan, shift, Eigen::Vector3d::Zero()))}};
  };
  nlohmann::json json{{"num_points", object.indices.size()},
                      {"planes", planesJson(object.planes, shift)},
                      {"axes", listOf(object.axes, [&](const auto& axis) { return axisJson(axis, shift); })},
                      {"centers", listOf(object.centers, centerJson)},
                      {"models", listOf(object.models, modelJson)},
                      {"tolerance", object.tolerance},
                      {"resolution", object.resolution},
                      {"diameter", object.diameter}};
  if (!object.reason.empty()) json["reason"] = object.reason;
  if (!object.model_reason.empty()) json["model_reason"] = object.model_reason;
  if (object.frame) json["frame"] = frameJson(*object.frame, shift);
  if (object.completed_by)
    json["completed"] = {{"by", numbersOf(*object.completed_by, shift)}, {"num_added", object.added.size()}};
  return json;
}

nlohmann::json describeJunction(const SceneJunction& junction) {
  return {{"objects", {junction.first + 1, junction.second + 1}},
          {"num_points", {junction.num_points[0], junction.num_points[1]}},
          {"joined", junction.isJoined()},
          {"together", junction.together},
          {"apart", junction.apart}};
}

std::string summaryOf(const SceneJunction& junction) {
  const std::string first = std::to_string(junction.first + 1),
                    points = " of " + std::to_string(junction.num_points[0]) + " and " +
                             counted(junction.num_points[1], "point");
  const std::string shares = formatted("one symmetry explains %.0f %% of both", 100.0 * junction.together) +
                             formatted(", their own %.0f %%", 100.0 * junction.apart);
  return (junction.isJoined() ? first + ": joined from pieces" + points
                              : first + " and " + std::to_string(junction.second + 1) + " touch") +
         ": " + shares + "\n";
}

/// For each point of the scene the number of its object, from 1; -1 for points of supporting planes, 0 for others.
std::vector<int> objectNumbers(const SceneAnalysis& scene, std::size_t num_points) {
  std::vector<int> numbers(num_points, 0);
  for (const SupportingPlane& support : scene.supports)
    for (const pcl::index_t i : support.indices) numbers[static_cast<std::size_t>(i)] = -1;
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
    for (const pcl::index_t i : scene.objects[k].indices)
      numbers[static_cast<std::size_t>(i)] = static_cast<int>(k) + 1;
  return numbers;
}

/// Looks at some points from the position of the sensor.
/// \param aside angle by which the camera is moved around the points, radians.
void lookFromSensor(PictureScene& picture, const SceneAnalysis& scene, const Eigen::Vector3d& middle,
                    double aside = 0.0) {
  std::optional<Eigen::Vector3d> viewpoint;
  if (const Visibility* seen = scene.seen->visibility()) viewpoint = seen->viewpoint();
  Eigen::Vector3d toward = viewpoint.value_or(middle) - middle, up = upFor(viewpoint, middle);
  toward.normalize();
  if (!scene.supports.empty()) {
    const Eigen::Vector3d support = scene.supports.front().coefficients.head<3>();
    if (std::abs(support.dot(toward)) < 0.95) up = support;  // a wall that faces the sensor is not below the objects
  }
  if (viewpoint) {
    if (std::abs(up.dot(toward)) > 0.95) up = toward.unitOrthogonal();
    toward = Eigen::AngleAxisd(aside, up) * toward;
    picture.view = (toward + kRaised * up).normalized();
  }
  picture.up = up;
}

/// \param k number of the object, from 0.
void markFindings(PicturePanel& panel, const SceneObject& object, const Cloud& scene, std::size_t k) {
  const Cloud points(scene, object.indices);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const pcl::PointXYZ& point : points) middle += point.getVector3fMap().cast<double>() / double(points.size());
  double reach = 0.0;
  for (const pcl::PointXYZ& point : points)
    reach = std::max(reach, (point.getVector3fMap().cast<double>() - middle).norm());
  const Eigen::Vector3d color = segmentColor(static_cast<int>(k));
  for (const SymmetryAxis& axis : object.axes) {
    const Eigen::Vector3d point = axis.point + axis.direction.dot(middle - axis.point) * axis.direction;
    panel.axes.push_back({point, axis.direction, color, kAxisReach * reach});
  }
  for (const SymmetryPlane& plane : object.planes)
    if (plane.kind == PlaneKind::Symmetry)
      panel.planes.push_back({plane.normal(), plane.offset(), middle, kPlaneReach * reach, color});
}

PictureScene closeUp(const InputShape& input, const SceneAnalysis& scene, std::size_t k) {
  const SceneObject& object = scene.objects[k];
  auto points = pcl::make_shared<Cloud>(*input.points, object.indices);
  PicturePanel panel;
  panel.segments.assign(points->size(), static_cast<int>(k));
  markFindings(panel, object, *input.points, k);
  const Eigen::Vector3d middle = points->front().getVector3fMap().cast<double>();
  *points += object.added;
  panel.segments.resize(points->size(), static_cast<int>(k) + kAddedColor);
  if (!object.added.empty())
    panel.legend = {{static_cast<int>(k), "measured"}, {static_cast<int>(k) + kAddedColor, "added"}};
  panel.label = std::to_string(k + 1) + ": " + summaryOf(object);
  PictureScene picture{points, {}, {panel}};
  lookFromSensor(picture, scene, middle, object.added.empty() ? 0.0 : kAside);  // added points lie at the back
  return picture;
}

PictureScene overview(const InputShape& input, const SceneAnalysis& scene) {
  const std::vector<int> numbers = objectNumbers(scene, input.points->size());
  auto points = pcl::make_shared<Cloud>();
  PicturePanel panel;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const std::size_t stride = 1 + input.points->size() / kDrawnPoints;
  double num_of_objects = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const pcl::PointXYZ& point = (*input.points)[i];
    if (!pcl::isXYZFinite(point) || (numbers[i] <= 0 && i % stride != 0)) continue;
    points->push_back(point);
    panel.segments.push_back(numbers[i] - 1);
    if (numbers[i] <= 0) panel.segments.back() = -1;
    if (numbers[i] > 0) middle += point.getVector3fMap().cast<double>(), ++num_of_objects;
  }
  if (num_of_objects > 0.0) middle /= num_of_objects;
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    markFindings(panel, scene.objects[k], *input.points, k);
    panel.legend.emplace_back(k, std::to_string(k + 1));
  }
  panel.label = counted(scene.objects.size(), "object") + ", " + counted(scene.supports.size(), "supporting plane");
  PictureScene picture{points, {}, {panel}};
  lookFromSensor(picture, scene, middle);
  return picture;
}

std::string tableOf(const SceneAnalysis& scene, const Eigen::Vector3d& shift) {
  const int digits = lengthDigits(shift);
  std::string text =
      counted(scene.supports.size(), "supporting plane") + ", " + counted(scene.objects.size(), "object") + "\n";
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const SceneObject& object = scene.objects[k];
    text += std::to_string(k + 1) + ": " + counted(object.indices.size(), "point") + ", " + summaryOf(object);
    if (object.frame) text += ", center " + spelled(shiftedBack(object.frame->center, shift), std::min(digits, 4));
    if (object.completed_by) text += ", " + counted(object.added.size(), "point") + " added";
    text += "\n";
  }
  for (const SceneJunction& junction : scene.junctions) text += summaryOf(junction);
  return text;
}

/// For each object: number, points, findings, model, and the center of its frame; null if there is none.
Rows rowsOf(const SceneAnalysis& scene, const Eigen::Vector3d& shift) {
  Rows rows;
  for (const SceneObject& object : scene.objects) {
    std::vector<nlohmann::json> row{
        rows.size() + 1, object.indices.size(), summaryOf(object),
        object.models.empty() ? nlohmann::json() : nlohmann::json(object.models.front().name)};
    for (int k = 0; k < 3; ++k)
      row.push_back(object.frame ? nlohmann::json(shiftedBack(object.frame->center, shift)[k]) : nlohmann::json());
    rows.push_back(row);
  }
  return rows;
}

nlohmann::json describeScene(const InputShape& input, const SceneAnalysis& scene) {
  const Eigen::Vector3d& shift = input.shift();
  const auto supportJson = [&](const SupportingPlane& support) -> nlohmann::json {
    const ReflectionPlane plane(support.coefficients.head<3>(), -support.coefficients[3]);
    return {{"coefficients", numbersOf(plane, shift)}, {"num_points", support.indices.size()}};
  };
  nlohmann::json json{
      {"file", input.path},
      {"num_points", finiteIndices(input.shape.cloud).size()},
      {"viewpoint", {{"from", toString(scene.seen->source())}}},
      {"plane_distance", scene.plane_distance},
      {"cluster_distance", scene.cluster_distance},
      {"supports", listOf(scene.supports, supportJson)},
      {"objects", listOf(scene.objects, [&](const auto& object) { return describeObject(object, shift); })},
      {"junctions", listOf(scene.junctions, describeJunction)},
      {"timing_ms", timingJson(scene.timing_ms)}};
  if (scene.seen->visibility())
    json["viewpoint"]["position"] = numbersOf(shiftedBack(scene.seen->visibility()->viewpoint(), shift));
  return json;
}

/// The fields x, y, z, object (0 = none, -1 = supporting plane, then 1, 2 ... as in the table) and completed (1 if a
/// symmetry added the point), for all finite points of the scene and the added ones.
pcl::PCLPointCloud2 completedScene(const InputShape& input, const SceneAnalysis& scene) {
  const std::vector<int> numbers = objectNumbers(scene, input.points->size());
  Cloud points;
  std::vector<float> object, completed;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!pcl::isXYZFinite((*input.points)[i])) continue;
    points.push_back((*input.points)[i]);
    object.push_back(static_cast<float>(numbers[i]));
  }
  completed.assign(object.size(), 0.0f);
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    points += scene.objects[k].added;
    object.resize(points.size(), static_cast<float>(k + 1));
  }
  completed.resize(points.size(), 1.0f);
  return withFields(toFields(points, input.shift()), {"object", "completed"}, {object, completed});
}

/// The scene from the position of the sensor, each object in its own color with its plane or axis, and the first
/// objects one by one, each with its planes and axes and the tolerance of its decision.
PictureScene selectableObjects(const InputShape& input, const SceneAnalysis& scene) {
  PictureScene picture = overview(input, scene);
  const std::vector<int> all = picture.panels.front().segments;
  for (std::size_t k = 0; k < scene.objects.size() && k < kMostPanels; ++k) {
    PicturePanel panel;
    for (const int segment : all) panel.segments.push_back(segment == static_cast<int>(k) ? segment : -1);
    markFindings(panel, scene.objects[k], *input.points, k);
    panel.label = std::to_string(k + 1) + ": " + summaryOf(scene.objects[k]);
    if (const std::string decided = toleranceOf(scene.objects[k]); !decided.empty()) panel.label += "; " + decided;
    picture.panels.push_back(std::move(panel));
  }
  return picture;
}

/// The colors of an organized cloud, pixel by pixel; empty if it has none.
RasterImage cameraPicture(const InputShape& input) {
  const pcl::PCLPointCloud2& cloud = input.shape.cloud;
  const int field = std::max(pcl::getFieldIndex(cloud, "rgb"), pcl::getFieldIndex(cloud, "rgba"));
  if (cloud.height < 2 || field < 0) return {};
  RasterImage picture(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)  // the cloud has the order blue, green, red
    picture.pixels[i] = cloud.data[i / 3 * cloud.point_step + cloud.fields[field].offset + 2 - i % 3];
  return picture;
}

void drawScene(const InputShape& input, const SceneAnalysis& scene, const std::string& path) {
  std::vector<PictureScene> panels = {overview(input, scene)};
  for (std::size_t k = 0; k < scene.objects.size() && k < kMostPanels; ++k) panels.push_back(closeUp(input, scene, k));
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(panels.size()))));
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  renderPicture(panels, path, std::max(2 * kPanelWidth, columns * kPanelWidth), std::max(2, rows) * kPanelHeight,
                columns);
}

/// \return null if no database is named.
std::shared_ptr<const SymmetryDatabase> openDatabase(const SceneToolOptions& options) {
  if (!options.database_path) return nullptr;
  checkReadableFile(*options.database_path);
  DatabaseOptions database;
  database.num_threads = options.common.threads;
  return namingFile(*options.database_path,
                    [&] { return std::make_shared<const SymmetryDatabase>(*options.database_path, database); });
}

/// The points of a depth image, in the frame of its camera: x to the right, y down, z forward.
InputShape loadDepth(const Console& console, const std::string& path, const SceneToolOptions& options) {
  if (!options.intrinsics) throw UsageError(path + ": a depth image needs -intrinsics FX,FY,CX,CY of its camera");
  const std::string& given = *options.intrinsics;
  const std::vector<double> k = parseNumbers("-intrinsics", given);
  if (k.size() != 4 || !(k[0] > 0.0 && k[1] > 0.0))
    rejectValue("-intrinsics", given, "must be FX,FY,CX,CY of the camera of " + path + ", FX and FY > 0");
  checkReadableFile(path);
  Step loading(console, "Loading " + path);
  InputShape input;
  input.path = path;
  input.points = input.shape.points = pcl::make_shared<Cloud>();
  functionOf<decltype(decodeDepth)>(kDrawingModule, "decodeDepth")(path, *input.points);
  for (pcl::PointXYZ& p : *input.points) {
    const double z = p.z > 0.0F ? p.z / options.depth_scale : std::nan("");
    p.getVector3fMap() = Eigen::Vector3d((p.x - k[2]) / k[0] * z, (p.y - k[3]) / k[1] * z, z).cast<float>();
  }
  input.points->is_dense = false;
  input.shape.cloud = toFields(*input.points, input.shift());
  input.loading_ms = loading.done(counted(finitePoints(*input.points).cols(), "point"));
  return input;
}

SceneAnalysis search(const FileJob& job, const InputShape& input, const SceneToolOptions& options,
                     const std::shared_ptr<const SymmetryDatabase>& database) {
  const CommonOptions& common = job.common;
  SceneOptions used = options.scene;
  used.detection.min_possible = std::min(used.detection.min_possible, used.detection.min_confidence);
  common.applyTo(used.detection);
  common.applyTo(used.frame);
  used.frames = !options.no_frames;
  used.complete = !options.no_completion;
  used.separate = !options.no_separation;
  used.num_threads = used.completion.num_threads = used.recognition.num_threads = common.threads;
  SymmetryScene scene;
  scene.setOptions(used);
  if (database) scene.setDatabase(database);
  scene.setViewpoint(shifted(options.common.viewpoint, input.shift()));
  if (options.ground) scene.setGround(shifted(*options.ground, input.shift()));
  scene.setInputCloud(input.points);
  Step searching(job.console, "Searching objects");
  SceneAnalysis found = namingFile(input.path, [&] { return scene.compute(); });
  if (!found.reason.empty()) throw InputError(input.path + ": input cloud: " + found.reason);
  const double total = searching.done(counted(found.objects.size(), "object"));
  found.timing_ms.emplace_back("load", input.loading_ms);
  found.timing_ms.emplace_back("total", total);
  if (!found.alone.empty())
    job.console.warn(input.path + ": " + found.alone +
                     "; if this is one object, pcl_symmetry_planes takes it as a whole");
  return found;
}

void analyze(const SceneToolOptions& options, const std::shared_ptr<const SymmetryDatabase>& database, FileJob& job) {
  const bool is_depth = boost::algorithm::iends_with(job.path, ".png");
  if (options.intrinsics && !is_depth) throw InputError(job.path + ": is no depth image, -intrinsics needs a .png");
  const InputShape input =
      is_depth ? loadDepth(job.console, job.path, options) : loadInput(job.console, job.path, job.common);
  if (input.shape.mesh) throw InputError(job.path + ": is a mesh, must be a cloud as a sensor sees it");
  const SceneAnalysis scene = search(job, input, options, database);
  std::string table = tableOf(scene, input.shift());
  for (std::size_t k = 0; options.explain && k < scene.objects.size(); ++k)
    table += formatted("object %zu\n", k + 1) + explained(scene.objects[k]);
  job.report({table, describeScene(input, scene), rowsOf(scene, input.shift())});
  if (options.output)
    saveCloud(job.output(*options.output), completedScene(input, scene), input.shape.sensor_origin,
              input.shape.sensor_orientation);
  if (options.png_path) {
    const std::string picture = job.output(*options.png_path);
    Step drawing(job.console, "Drawing " + picture);
    drawScene(input, scene, picture);
    drawing.done();
  }
  if (options.html_path)
    writePage(selectableObjects(input, scene), {job.path, table, cameraPicture(input)}, job.output(*options.html_path));
}

int run(int argc, char** argv) {
  SceneToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-intrinsics", options.intrinsics.has_value(), {"depth_scale"});
  line.goWith("-database", options.database_path.has_value(), {"accept"});
  if (options.output) checkCloudExtension(*options.output);
  const std::shared_ptr<const SymmetryDatabase> database = openDatabase(options);
  options.batch.inputs = {options.input};
  return runOnFiles(options.batch, options.common, {"object", "points", "found", "model", "x", "y", "z"},
                    [&](FileJob& job) { analyze(options, database, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
