#include "scene/scene_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/directions.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

namespace {

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

/// The findings about an object, in words.
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

/// The tolerance at which an object was decided, in words.
std::string toleranceOf(const SceneObject& object) {
  if (!(object.diameter > 0.0)) return "";
  const auto share = [&](double length) { return 100.0 * length / object.diameter; };
  std::string text = formatted("decided at %.1f %% of the diameter", share(object.tolerance));
  if (object.resolution > 0.0) text += formatted(", the points resolve %.1f %%", share(object.resolution));
  return text;
}

nlohmann::json describeObject(const SceneObject& object, const Eigen::Vector3d& shift) {
  nlohmann::json json{{"num_points", object.indices.size()}, {"planes", nlohmann::json::array()},
                      {"axes", nlohmann::json::array()},     {"centers", nlohmann::json::array()},
                      {"models", nlohmann::json::array()},   {"tolerance", object.tolerance},
                      {"resolution", object.resolution},     {"diameter", object.diameter}};
  if (!object.reason.empty()) json["reason"] = object.reason;
  if (!object.model_reason.empty()) json["model_reason"] = object.model_reason;
  for (const SymmetryPlane& plane : object.planes) json["planes"].push_back(planeJson(plane, shift));
  for (const SymmetryAxis& axis : object.axes) json["axes"].push_back(axisJson(axis, shift));
  for (const SymmetryCenter& center : object.centers)
    json["centers"].push_back(
        {{"point", numbersOf(shiftedBack(center.point, shift))}, {"confidence", center.confidence}});
  if (object.frame) json["frame"] = frameJson(*object.frame, shift);
  if (object.completed_by)
    json["completed"] = {{"by", numbersOf(*object.completed_by, shift)}, {"num_added", object.added.size()}};
  for (const RecognizedModel& model : object.models)
    json["models"].push_back(
        {{"name", model.name},
         {"confidence", model.confidence},
         {"merit", model.score.merit()},
         {"T_model_scene", rowMajor(shiftedBack(model.T_model_scan, shift, Eigen::Vector3d::Zero()))}});
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

void markFindings(PicturePanel& panel, const SceneObject& object, const SymmetryScene::Cloud& points,
                  const Eigen::Vector3d& color) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const pcl::PointXYZ& point : points) middle += point.getVector3fMap().cast<double>() / double(points.size());
  double reach = 0.0;
  for (const pcl::PointXYZ& point : points)
    reach = std::max(reach, (point.getVector3fMap().cast<double>() - middle).norm());
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
  auto points = pcl::make_shared<SymmetryScene::Cloud>(*input.points, object.indices);
  PicturePanel panel;
  panel.segments.assign(points->size(), static_cast<int>(k));
  markFindings(panel, object, *points, segmentColor(static_cast<int>(k)));
  const Eigen::Vector3d middle = points->front().getVector3fMap().cast<double>();
  *points += object.added;
  panel.segments.resize(points->size(), static_cast<int>(k) + kAddedColor);
  if (!object.added.empty())
    panel.legend = {{static_cast<int>(k), "measured"}, {static_cast<int>(k) + kAddedColor, "added"}};
  panel.label = std::to_string(k + 1) + ": " + summaryOf(object);
  PictureScene picture;
  picture.points = points;
  picture.panels = {panel};
  lookFromSensor(picture, scene, middle, object.added.empty() ? 0.0 : kAside);  // added points lie at the back
  return picture;
}

/// All objects in one view.
PictureScene overview(const InputShape& input, const SceneAnalysis& scene) {
  const std::vector<int> numbers = objectNumbers(scene, input.points->size());
  auto points = pcl::make_shared<SymmetryScene::Cloud>();
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
    markFindings(panel, scene.objects[k], SymmetryScene::Cloud(*input.points, scene.objects[k].indices),
                 segmentColor(static_cast<int>(k)));
    panel.legend.emplace_back(k, std::to_string(k + 1));
  }
  panel.label = counted(scene.objects.size(), "object") + ", " + counted(scene.supports.size(), "supporting plane");
  PictureScene picture;
  picture.points = points;
  picture.panels = {panel};
  lookFromSensor(picture, scene, middle);
  return picture;
}

}  // namespace

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

std::vector<std::vector<nlohmann::json>> rowsOf(const SceneAnalysis& scene, const Eigen::Vector3d& shift) {
  std::vector<std::vector<nlohmann::json>> rows;
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
  nlohmann::json json{{"file", input.path},
                      {"num_points", finiteIndices(input.shape.cloud).size()},
                      {"viewpoint", {{"from", toString(scene.seen->source())}}},
                      {"plane_distance", scene.plane_distance},
                      {"cluster_distance", scene.cluster_distance},
                      {"supports", nlohmann::json::array()},
                      {"objects", nlohmann::json::array()},
                      {"junctions", nlohmann::json::array()},
                      {"timing_ms", timingJson(scene.timing_ms)}};
  if (scene.seen->visibility())
    json["viewpoint"]["position"] = numbersOf(shiftedBack(scene.seen->visibility()->viewpoint(), input.shift()));
  for (const SupportingPlane& support : scene.supports) {
    const ReflectionPlane plane(support.coefficients.head<3>(), -support.coefficients[3]);
    json["supports"].push_back(
        {{"coefficients", numbersOf(plane, input.shift())}, {"num_points", support.indices.size()}});
  }
  for (const SceneObject& object : scene.objects) json["objects"].push_back(describeObject(object, input.shift()));
  for (const SceneJunction& junction : scene.junctions) json["junctions"].push_back(describeJunction(junction));
  return json;
}

pcl::PCLPointCloud2 completedScene(const InputShape& input, const SceneAnalysis& scene) {
  const std::vector<int> numbers = objectNumbers(scene, input.points->size());
  SymmetryScene::Cloud points;
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

PictureScene selectableObjects(const InputShape& input, const SceneAnalysis& scene) {
  PictureScene picture = overview(input, scene);
  const std::vector<int> all = picture.panels.front().segments;
  for (std::size_t k = 0; k < scene.objects.size() && k < kMostPanels; ++k) {
    PicturePanel panel;
    for (const int segment : all) panel.segments.push_back(segment == static_cast<int>(k) ? segment : -1);
    markFindings(panel, scene.objects[k], SymmetryScene::Cloud(*input.points, scene.objects[k].indices),
                 segmentColor(static_cast<int>(k)));
    panel.label = std::to_string(k + 1) + ": " + summaryOf(scene.objects[k]);
    if (const std::string decided = toleranceOf(scene.objects[k]); !decided.empty()) panel.label += "; " + decided;
    picture.panels.push_back(std::move(panel));
  }
  return picture;
}

RasterImage cameraPicture(const InputShape& input) {
  const pcl::PCLPointCloud2& cloud = input.shape.cloud;
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), [](const pcl::PCLPointField& candidate) {
    return candidate.name == "rgb" || candidate.name == "rgba";
  });
  if (cloud.height < 2 || field == cloud.fields.end()) return {};
  RasterImage picture(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)  // the cloud has the order blue, green, red
    picture.pixels[i] = cloud.data[i / 3 * cloud.point_step + field->offset + 2 - i % 3];
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

}  // namespace pcl_symmetry::apps
