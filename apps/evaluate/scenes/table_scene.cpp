#include "evaluate/scenes/table_scene.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/scanner/random_numbers.h"
#include "core/base/constants.h"
#include "core/base/random.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();  // derived: depth of a ray that meets nothing
// Half the side of the square that objects are placed in, metres: for one object, and more for each root of their
// number. chosen: objects of 0.15 to 0.3 m stand as close as they can; half leaves many out, twice hides few.
constexpr double kPlaceOfOne = 0.02, kPlacePerRoot = 0.08;
// Half the side of the table beyond that square, metres. chosen: room for the objects; any larger one will do.
constexpr double kTableRim = 0.4;
// Metres, the walls of a bin, and from its objects to the walls. chosen: as high as objects of 0.15 to 0.3 m are; at
// half, walls hide nothing, at twice, little is seen.
constexpr double kBinHeight = 0.15, kBinThickness = 0.01, kBinGap = 0.01;
// Radians: a part of a turn that shows the scene, between columns, and from the first ring to the last. derived: a
// scanner with 16 rings that turns five times a second has 0.1 degrees from column to column (VLP-16), one with 64
// rings has them over 26.8 degrees (HDL-64E).
constexpr double kScannedTurn = 60.0 * kDegree, kColumnStep = 0.1 * kDegree, kRingField = 26.8 * kDegree;
// Trials for a place. chosen: half leaves more objects out, twice takes time.
constexpr int kTrials = 100;

// Share of the scenes that are looked at along the line from an object to its nearest neighbour, and how far the camera
// is beside that line, radians. chosen: from anywhere few objects are hidden by more than 30 %; half the angle hides
// more of fewer objects, twice is nearly anywhere.
constexpr double kAlignedShare = 0.8, kJitter = 0.5;

enum Stream : std::uint64_t { kObjects, kPlaces, kCamera, kNoise };

double between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// One of the six ways to stand on a face of the bounding box, turned about the vertical.
Eigen::Matrix3d standing(RandomStream& random) {
  static const Eigen::Vector3d kUps[] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  const Eigen::Vector3d up = kUps[random.below(3)] * (random.below(2) ? 1.0 : -1.0);
  const Eigen::Matrix3d upright = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return Eigen::AngleAxisd(between(random, 0.0, 2.0 * kPi), Eigen::Vector3d::UnitZ()).toRotationMatrix() * upright;
}

/// An object on the table, and the circle around it.
struct Standing {
  PlacedModel placed;
  Eigen::Vector2d center;
  double radius;
};

std::optional<Standing> findPlace(const SceneModel& model, std::size_t index, const std::vector<Standing>& others,
                                  double half_side, double gap, RandomStream& random) {
  const Eigen::Matrix3d turn = standing(random);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : model.vertices) box.extend(turn * vertex);
  const Eigen::Vector2d middle = box.center().head<2>();
  double radius = 0.0;
  for (const Eigen::Vector3d& vertex : model.vertices)
    radius = std::max(radius, ((turn * vertex).head<2>() - middle).norm());
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector2d at(between(random, -half_side, half_side), between(random, -half_side, half_side));
    const bool is_free = std::all_of(others.begin(), others.end(), [&](const Standing& other) {
      return (other.center - at).norm() > other.radius + radius + gap;
    });
    if (!is_free) continue;
    Standing standing{{index, Eigen::Isometry3d::Identity()}, at, radius};
    standing.placed.T_scene_model.linear() = turn;
    standing.placed.T_scene_model.translation() << at - middle, -box.min().z();
    return standing;
  }
  return std::nullopt;
}

/// The direction, seen from above, in which the camera stands: any, or where the nearest neighbour of an object is in
/// front of it.
double azimuthOf(const std::vector<Standing>& placed, RandomStream& random) {
  const double anywhere = between(random, 0.0, 2.0 * kPi), jitter = between(random, -kJitter, kJitter);
  if (placed.size() < 2 || random.uniform() >= kAlignedShare) return anywhere;
  const Standing& hidden = placed[random.below(placed.size())];
  const Standing* nearest = nullptr;
  for (const Standing& other : placed) {
    if (&other == &hidden) continue;
    if (!nearest || (other.center - hidden.center).norm() < (nearest->center - hidden.center).norm()) nearest = &other;
  }
  const Eigen::Vector2d towards = nearest->center - hidden.center;
  return std::atan2(towards.y(), towards.x()) + jitter;
}

Eigen::Isometry3d lookAtMiddle(const SceneOptionsOfTable& options, double azimuth, RandomStream& random) {
  const double low = options.in_bin ? options.least_elevation_of_bin : options.least_elevation;
  const double high = options.in_bin ? options.greatest_elevation_of_bin : options.greatest_elevation;
  const double elevation = between(random, low, high) * kDegree;
  const double distance = between(random, options.least_distance, options.greatest_distance);
  const Eigen::Vector3d towards(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
  Eigen::Isometry3d T_scene_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = -towards, right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_scene_camera.linear() << right, forward.cross(right), forward;
  T_scene_camera.translation() = distance * towards;
  return T_scene_camera;
}

/// Depths of one thing along the rays of a sensor, in lengths of the rays.
class DepthOf {
public:
  DepthOf(const SceneModel& model, const PlacedModel& placed, const SceneSensor& sensor)
      : triangles_(*model.triangles),
        T_model_sensor_(placed.T_scene_model.inverse() * sensor.T_scene_sensor),
        center_(T_model_sensor_.inverse() * triangles_.center()),
        origin_((T_model_sensor_.translation() - triangles_.center()) / triangles_.diagonal()) {}

  /// \param ray in the frame of the sensor.
  double along(const Eigen::Vector3d& ray) const {
    const double radius = 0.5 * triangles_.diagonal(), sq_length = ray.squaredNorm(), forward = center_.dot(ray);
    // The ball around the box of the thing: most rays pass it.
    if (!(forward > 0.0) || center_.squaredNorm() * sq_length - forward * forward > radius * radius * sq_length)
      return kInfinity;
    const double length = std::sqrt(sq_length);
    return distanceAlong(triangles_, origin_, T_model_sensor_.linear() * ray / length) * triangles_.diagonal() / length;
  }

private:
  const TriangleScene& triangles_;
  Eigen::Isometry3d T_model_sensor_;
  Eigen::Vector3d center_, origin_;  // of the box in the frame of the sensor; of the sensor in that of the triangles
};

double depthOfTable(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double half_side) {
  const double depth = -origin.z() / direction.z();
  if (!(depth > 0.0)) return kInfinity;
  return (origin + depth * direction).head<2>().cwiseAbs().maxCoeff() <= half_side ? depth : kInfinity;
}

/// \return the depth at which a ray enters a box.
double depthOfBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const Eigen::AlignedBox3d& box) {
  double enters = 0.0, leaves = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double one = (box.min()[k] - origin[k]) / direction[k], other = (box.max()[k] - origin[k]) / direction[k];
    enters = std::max(enters, std::min(one, other));
    leaves = std::min(leaves, std::max(one, other));
  }
  return enters > 0.0 && enters <= leaves ? enters : kInfinity;
}

/// Table and bin along the rays of a sensor.
class DepthOfPlace {
public:
  explicit DepthOfPlace(const TableScene& scene)
      : sensor_(scene.sensor),
        half_side_(kTableRim + kPlaceOfOne +
                   kPlacePerRoot * std::sqrt(static_cast<double>(std::max<std::size_t>(1, scene.objects.size())))),
        walls_(scene.bin ? scene.bin->walls() : std::vector<Eigen::AlignedBox3d>()) {
    if (scene.bin) half_side_ = std::max(half_side_, scene.bin->half_side + kTableRim);
  }

  double along(const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d direction = sensor_.T_scene_sensor.linear() * ray;
    const Eigen::Vector3d origin = sensor_.T_scene_sensor.translation();
    double nearest = depthOfTable(origin, direction, half_side_);
    for (const Eigen::AlignedBox3d& wall : walls_) nearest = std::min(nearest, depthOfBox(origin, direction, wall));
    return nearest;
  }

private:
  const SceneSensor& sensor_;
  double half_side_;
  std::vector<Eigen::AlignedBox3d> walls_;
};

/// The depth that a camera with structured light says: it measures disparities, the inverse of the depth, in whole
/// steps. A step of the disparity is one of noise.step * depth^2 in depth.
double measuredDepth(double depth, const DepthNoise& noise, RandomStream& random) {
  const double step = noise.factor * noise.step;
  const double disparity = 1.0 / (step * depth) + noise.deviation / noise.step * standardNormal(random);
  return 1.0 / (step * std::max(1.0, std::round(disparity)));
}

/// Adds the errors of the sensor to the depths.
void addNoise(std::vector<double>& depths, const SceneSensor& sensor, const DepthNoise& noise, std::uint64_t seed) {
  if (!(noise.factor > 0.0)) return;
  RandomStream random(seed, kNoise);
  const std::vector<double> truth = depths;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!std::isfinite(truth[i])) continue;
    double& depth = depths[i];
    if (sensor.kind == SensorKind::Lidar) {
      depth += noise.factor * noise.range_deviation * standardNormal(random);
      continue;
    }
    for (const std::size_t beside : {i + 1, i + static_cast<std::size_t>(sensor.width)}) {
      if (beside >= truth.size() || !std::isfinite(truth[beside])) continue;
      const bool at_edge = std::abs(truth[beside] - truth[i]) > noise.least_edge * truth[i];
      if (at_edge && random.uniform() < noise.factor * noise.flying_share)
        depth = between(random, truth[i], truth[beside]);
    }
    depth = measuredDepth(depth, noise, random);
  }
}

/// Leaves what met nothing out of a cloud without rows.
void dropEmpty(SceneImage& image) {
  std::vector<int> ids;
  auto kept = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < image.ids.size(); ++i) {
    if (image.ids[i] == -2) continue;
    kept->push_back((*image.cloud)[i]);
    ids.push_back(image.ids[i]);
  }
  kept->sensor_origin_ = image.cloud->sensor_origin_;
  kept->sensor_orientation_ = image.cloud->sensor_orientation_;
  image.cloud = kept;
  image.ids = std::move(ids);
}

pcl::PointCloud<pcl::PointXYZ>::Ptr cloudOf(const SceneSensor& sensor, const std::vector<double>& depths) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>(sensor.width, sensor.height));
  for (int row = 0; row < sensor.height; ++row)
    for (int column = 0; column < sensor.width; ++column) {
      const double depth = depths[static_cast<std::size_t>(row) * sensor.width + column];
      const Eigen::Vector3d point = sensor.T_scene_sensor * Eigen::Vector3d(depth * sensor.rayThrough(column, row));
      cloud->at(column, row).getVector3fMap() =
          std::isfinite(depth) ? Eigen::Vector3f(point.cast<float>())
                               : Eigen::Vector3f(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
  cloud->is_dense = false;
  cloud->sensor_origin_ << sensor.T_scene_sensor.translation().cast<float>(), 0.0f;
  cloud->sensor_orientation_ = Eigen::Quaterniond(sensor.T_scene_sensor.linear()).cast<float>();
  return cloud;
}

}  // namespace

SceneModel::SceneModel(std::string model_name, const pcl::PolygonMesh& shape, double diagonal)
    : name(std::move(model_name)), mesh(shape) {
  const TriangleScene own(mesh);
  pcl::PointCloud<pcl::PointXYZ> points;
  pcl::fromPCLPointCloud2(mesh.cloud, points);
  for (pcl::PointXYZ& point : points)
    point.getVector3fMap() =
        ((point.getVector3fMap().cast<double>() - own.center()) * (diagonal / own.diagonal())).cast<float>();
  pcl::toPCLPointCloud2(points, mesh.cloud);
  triangles = std::make_shared<const TriangleScene>(mesh);
  for (const Triangle& triangle : triangles->triangles())
    for (const Eigen::Vector3d* corner : {&triangle.a, &triangle.b, &triangle.c})
      vertices.push_back(triangles->center() + triangles->diagonal() * *corner);
}

TableScene drawScene(const std::vector<SceneModel>& models, const SceneOptionsOfTable& options, std::uint64_t seed) {
  RandomStream objects(seed, kObjects), places(seed, kPlaces), camera(seed, kCamera);
  const auto num_objects = 1 + objects.below(static_cast<std::uint64_t>(options.most_objects));
  const double half_side = kPlaceOfOne + kPlacePerRoot * std::sqrt(static_cast<double>(num_objects));
  std::vector<Standing> placed;
  for (std::uint64_t i = 0; i < num_objects; ++i) {
    const std::size_t model = objects.below(models.size());
    if (auto standing = findPlace(models[model], model, placed, half_side, options.gap, places))
      placed.push_back(*standing);
  }
  TableScene scene;
  double reach = 0.0;
  for (const Standing& standing : placed) {
    scene.objects.push_back(standing.placed);
    reach = std::max(reach, standing.center.cwiseAbs().maxCoeff() + standing.radius);
  }
  if (options.in_bin) scene.bin = Bin{reach + kBinGap, kBinHeight, kBinThickness};
  scene.sensor = options.sensor;
  scene.sensor.T_scene_sensor = lookAtMiddle(options, azimuthOf(placed, camera), camera);
  return scene;
}

SceneSensor SceneSensor::lidar(int num_rings) {
  SceneSensor sensor;
  sensor.kind = SensorKind::Lidar;
  sensor.height = num_rings;
  sensor.column_step = kColumnStep;
  sensor.ring_step = kRingField / (num_rings - 1);
  sensor.width = static_cast<int>(kScannedTurn / kColumnStep);
  return sensor;
}

Eigen::Vector3d SceneSensor::rayThrough(int column, int row) const {
  const double right = column + 0.5 - 0.5 * width, down = row + 0.5 - 0.5 * height;
  if (kind == SensorKind::Camera) return {right / focal, down / focal, 1.0};
  const double turn = right * column_step, fall = down * ring_step;
  return {std::cos(fall) * std::sin(turn), std::sin(fall), std::cos(fall) * std::cos(turn)};
}

std::vector<Eigen::AlignedBox3d> Bin::walls() const {
  const double outer = half_side + thickness;
  std::vector<Eigen::AlignedBox3d> walls;
  for (const double side : {-1.0, 1.0}) {
    const double low = side < 0.0 ? -outer : half_side, high = low + thickness;
    walls.emplace_back(Eigen::Vector3d(low, -outer, 0.0), Eigen::Vector3d(high, outer, height));
    walls.emplace_back(Eigen::Vector3d(-outer, low, 0.0), Eigen::Vector3d(outer, high, height));
  }
  return walls;
}

std::vector<Eigen::Vector4d> Bin::innerFaces() const {
  std::vector<Eigen::Vector4d> faces;
  for (int k = 0; k < 2; ++k)
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector4d face = side * Eigen::Vector4d::Unit(k);
      face[3] = half_side;
      faces.push_back(face);
    }
  return faces;
}

SceneImage renderScene(const std::vector<SceneModel>& models, const TableScene& scene, const DepthNoise& noise,
                       std::uint64_t seed) {
  const SceneSensor& sensor = scene.sensor;
  const std::size_t num_objects = scene.objects.size();
  SceneImage image{nullptr,
                   {},
                   std::vector<int>(num_objects, 0),
                   std::vector<int>(num_objects, 0),
                   std::vector<bool>(num_objects, false)};
  std::vector<DepthOf> things;
  for (const PlacedModel& object : scene.objects) things.emplace_back(models[object.model], object, sensor);
  const DepthOfPlace place(scene);
  std::vector<double> depths;
  for (int row = 0; row < sensor.height; ++row) {
    for (int column = 0; column < sensor.width; ++column) {
      const Eigen::Vector3d ray = sensor.rayThrough(column, row);
      double nearest = place.along(ray);
      int id = std::isfinite(nearest) ? -1 : -2;
      for (std::size_t k = 0; k < num_objects; ++k) {
        const double depth = things[k].along(ray);
        if (!std::isfinite(depth)) continue;
        ++image.num_alone[k];
        if (row == 0 || column == 0 || row + 1 == sensor.height || column + 1 == sensor.width) image.cropped[k] = true;
        if (!(depth < nearest)) continue;
        nearest = depth;
        id = static_cast<int>(k);
      }
      if (id >= 0) ++image.num_visible[static_cast<std::size_t>(id)];
      image.ids.push_back(id);
      depths.push_back(nearest);
    }
  }
  addNoise(depths, sensor, noise, seed);
  image.cloud = cloudOf(sensor, depths);
  if (sensor.kind == SensorKind::Lidar) dropEmpty(image);
  return image;
}

}  // namespace pcl_symmetry::apps
