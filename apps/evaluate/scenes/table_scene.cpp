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
// Least depth of a ball, metres. chosen: avoids a division by 0; the camera stands much farther away.
constexpr double kNearest = 1e-3;
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
  const double elevation = between(random, options.least_elevation, options.greatest_elevation) * kDegree;
  const double distance = between(random, options.least_distance, options.greatest_distance);
  const Eigen::Vector3d towards(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
  Eigen::Isometry3d T_scene_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = -towards, right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_scene_camera.linear() << right, forward.cross(right), forward;
  T_scene_camera.translation() = distance * towards;
  return T_scene_camera;
}

/// Depths along the forward axis of a camera, of one thing.
class DepthOf {
public:
  DepthOf(const SceneModel& model, const PlacedModel& placed, const DepthCamera& camera)
      : triangles_(*model.triangles), T_model_camera_(placed.T_scene_model.inverse() * camera.T_scene_camera) {
    const Eigen::Vector3d center = T_model_camera_.inverse() * triangles_.center();
    const double radius = 0.5 * triangles_.diagonal();
    // The picture of a ball lies in that of a square around it at its nearest depth.
    const double depth = std::max(center.z() - radius, kNearest);
    const double reach = radius * (1.0 + center.norm() / depth);
    for (int k = 0; k < 2; ++k) {
      const double size = k == 0 ? camera.width : camera.height;
      const double middle = camera.focal * center[k] / center.z() + 0.5 * size;
      const double half = camera.focal * reach / center.z();
      low_[k] = static_cast<int>(std::clamp(middle - half, 0.0, size));
      high_[k] = static_cast<int>(std::clamp(middle + half + 1.0, 0.0, size));
    }
  }

  /// \param ray z = 1 in the frame of the camera.
  double along(int column, int row, const Eigen::Vector3d& ray) const {
    if (column < low_[0] || column >= high_[0] || row < low_[1] || row >= high_[1]) return kInfinity;
    const Eigen::Vector3d origin = (T_model_camera_.translation() - triangles_.center()) / triangles_.diagonal();
    const double length = ray.norm();
    return distanceAlong(triangles_, origin, T_model_camera_.linear() * ray / length) * triangles_.diagonal() / length;
  }

private:
  const TriangleScene& triangles_;
  Eigen::Isometry3d T_model_camera_;
  int low_[2], high_[2];
};

double depthOfTable(const DepthCamera& camera, const Eigen::Vector3d& ray, double half_side) {
  const Eigen::Vector3d direction = camera.T_scene_camera.linear() * ray, origin = camera.T_scene_camera.translation();
  const double depth = -origin.z() / direction.z();
  if (!(depth > 0.0)) return kInfinity;
  return (origin + depth * direction).head<2>().cwiseAbs().maxCoeff() <= half_side ? depth : kInfinity;
}

/// Adds the errors of the camera to the depths.
void addNoise(std::vector<double>& depths, int width, const DepthNoise& noise, std::uint64_t seed) {
  if (!(noise.factor > 0.0)) return;
  RandomStream random(seed, kNoise);
  const std::vector<double> truth = depths;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!std::isfinite(truth[i])) continue;
    double& depth = depths[i];
    for (const std::size_t beside : {i + 1, i + static_cast<std::size_t>(width)}) {
      if (beside >= truth.size() || !std::isfinite(truth[beside])) continue;
      const bool at_edge = std::abs(truth[beside] - truth[i]) > noise.least_edge * truth[i];
      if (at_edge && random.uniform() < noise.factor * noise.flying_share)
        depth = between(random, truth[i], truth[beside]);
    }
    const double square = depth * depth * noise.factor;
    depth += noise.deviation * square * standardNormal(random);
    const double step = noise.step * square;
    depth = std::max(step, std::round(depth / step) * step);
  }
}

pcl::PointCloud<pcl::PointXYZ>::Ptr cloudOf(const DepthCamera& camera, const std::vector<double>& depths) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>(camera.width, camera.height));
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      const double depth = depths[static_cast<std::size_t>(row) * camera.width + column];
      const Eigen::Vector3d point = camera.T_scene_camera * Eigen::Vector3d(depth * camera.rayThrough(column, row));
      cloud->at(column, row).getVector3fMap() =
          std::isfinite(depth) ? Eigen::Vector3f(point.cast<float>())
                               : Eigen::Vector3f(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
  cloud->is_dense = false;
  cloud->sensor_origin_ << camera.T_scene_camera.translation().cast<float>(), 0.0f;
  cloud->sensor_orientation_ = Eigen::Quaterniond(camera.T_scene_camera.linear()).cast<float>();
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
  for (const Standing& standing : placed) scene.objects.push_back(standing.placed);
  scene.camera.T_scene_camera = lookAtMiddle(options, azimuthOf(placed, camera), camera);
  return scene;
}

SceneImage renderScene(const std::vector<SceneModel>& models, const TableScene& scene, const DepthNoise& noise,
                       std::uint64_t seed) {
  const DepthCamera& camera = scene.camera;
  const std::size_t num_objects = scene.objects.size();
  SceneImage image{nullptr,
                   {},
                   std::vector<int>(num_objects, 0),
                   std::vector<int>(num_objects, 0),
                   std::vector<bool>(num_objects, false)};
  std::vector<DepthOf> things;
  for (const PlacedModel& object : scene.objects) things.emplace_back(models[object.model], object, camera);
  const double half_side =
      kTableRim + kPlaceOfOne + kPlacePerRoot * std::sqrt(static_cast<double>(std::max<std::size_t>(1, num_objects)));
  std::vector<double> depths;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const Eigen::Vector3d ray = camera.rayThrough(column, row);
      double nearest = depthOfTable(camera, ray, half_side);
      int id = std::isfinite(nearest) ? -1 : -2;
      for (std::size_t k = 0; k < num_objects; ++k) {
        const double depth = things[k].along(column, row, ray);
        if (!std::isfinite(depth)) continue;
        ++image.num_alone[k];
        if (row == 0 || column == 0 || row + 1 == camera.height || column + 1 == camera.width) image.cropped[k] = true;
        if (!(depth < nearest)) continue;
        nearest = depth;
        id = static_cast<int>(k);
      }
      if (id >= 0) ++image.num_visible[static_cast<std::size_t>(id)];
      image.ids.push_back(id);
      depths.push_back(nearest);
    }
  }
  addNoise(depths, camera.width, noise, seed);
  image.cloud = cloudOf(camera, depths);
  return image;
}

}  // namespace pcl_symmetry::apps
