#include "evaluate/clouds/test_clouds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "common/command_line/flag_values.h"
#include "common/scanner/random_numbers.h"
#include "core/base/constants.h"
#include "core/base/random.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

// Edge of the picture of a scan, pixels; wires get fewer points. chosen: that of depth cameras.
constexpr int kMaxResolution = 1024;

/// Streams of random numbers of one model.
enum Stream : std::uint64_t { kSampling, kNoise, kCut, kPose, kView, kMove, kPattern };

/// FNV-1a, so that a model's clouds depend on nothing but its key and the seed.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  return hash;
}

std::uint64_t seedOf(std::uint64_t seed, Stream stream, std::uint64_t index = 0) {
  return RandomStream(seed, 1000 * index + stream)();
}

Eigen::Vector3d randomDirection(RandomStream& random) {
  const double z = 2.0 * uniform(random) - 1.0, angle = 2.0 * kPi * uniform(random), ring = std::sqrt(1.0 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

/// Takes away the points of the given share that lie furthest along the direction.
void cut(pcl::PointCloud<pcl::PointXYZ>& cloud, double share, const Eigen::Vector3d& direction) {
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const Eigen::Vector3f d = direction.cast<float>();
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return d.dot(cloud[a].getVector3fMap()) < d.dot(cloud[b].getVector3fMap());
  });
  order.resize(std::max<std::size_t>(2, std::lround((1.0 - share) * static_cast<double>(cloud.size()))));
  std::sort(order.begin(), order.end());
  pcl::PointCloud<pcl::PointXYZ> kept;
  for (const std::size_t i : order) kept.push_back(cloud[i]);
  cloud = kept;
}

/// \param motion of the scan about \p center, the model's. Points that are not finite are left out.
void moveAndForgetViewpoint(TestCloud& scan, Eigen::Isometry3d motion, const Eigen::Vector3d& center) {
  motion.translation() -= motion.linear() * center;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr moved(new pcl::PointCloud<pcl::PointXYZ>);
  for (const pcl::PointXYZ& point : *scan.cloud) {
    if (!point.getVector3fMap().allFinite()) continue;
    const Eigen::Vector3f x = (motion * point.getVector3fMap().cast<double>()).cast<float>();
    moved->push_back(pcl::PointXYZ(x.x(), x.y(), x.z()));
  }
  scan.cloud = moved;
  scan.T_cloud_model = motion * scan.T_cloud_model;
  scan.view->direction = motion.linear() * scan.view->direction;
  scan.view->T_cloud_sensor = motion * scan.view->T_cloud_sensor;
}

/// Keeps one row of the picture in \p distance, as a scanner with few lasers has them.
void keepRings(pcl::PointCloud<pcl::PointXYZ>& cloud, int distance) {
  pcl::PointCloud<pcl::PointXYZ> kept(cloud.width, (cloud.height + distance - 1) / distance);
  for (std::uint32_t row = 0; row < kept.height; ++row)
    for (std::uint32_t column = 0; column < kept.width; ++column)
      kept(column, row) = cloud(column, row * static_cast<std::uint32_t>(distance));
  kept.is_dense = cloud.is_dense;
  kept.sensor_origin_ = cloud.sensor_origin_;
  kept.sensor_orientation_ = cloud.sensor_orientation_;
  cloud = kept;
}

/// Collects recipes; what is not said keeps its default.
class RecipeList {
public:
  explicit RecipeList(const TestCloudOptions& options) : options_(options) {}

  void addWhole(const std::string& what, double x, double noise, double missing, int num_points) {
    CloudRecipe recipe;
    recipe.group = "whole, " + what + " " + shortest(x);
    recipe.name = "whole_" + what + "_" + shortest(x);
    recipe.x = x;
    recipe.num_points = num_points;
    recipe.noise = noise;
    recipe.missing = missing;
    recipes_.push_back(recipe);
  }

  void addScans(bool moved) {
    const int num_views = options_.random_views ? options_.num_views : std::min(options_.num_views, 8);
    for (const double noise : options_.scan_noise) {
      for (int view = 0; view < num_views; ++view) {
        CloudRecipe recipe;
        recipe.group = std::string(moved ? "moved scan, noise " : "scan, noise ") + shortest(noise);
        recipe.name = (moved ? "moved_" : "scan_") + std::to_string(view) + "_noise_" + shortest(noise);
        recipe.x = recipe.noise = noise;
        recipe.num_points = options_.num_points;
        recipe.view = view;
        recipe.moved = moved;
        recipes_.push_back(recipe);
      }
    }
  }

  void addCrops() {
    for (const double share : options_.crops) {
      addWhole("cut off", share, 0.0, share, options_.num_points);
      recipes_.back().group = "cut off, " + shortest(share);
      recipes_.back().name = "crop_" + shortest(share);
    }
  }

  void addPatterns() {
    for (const SamplingPattern pattern : kSamplingPatterns) {
      addWhole(toString(pattern), 0.0, 0.0, 0.0, options_.num_points);
      recipes_.back().group = std::string("whole, ") + toString(pattern);
      recipes_.back().name = std::string("whole_") + toString(pattern);
      recipes_.back().pattern = pattern;
    }
  }

  void addRow(CloudRow row) {
    switch (row) {
      case CloudRow::Whole:
      case CloudRow::Noise:
        for (const double noise : options_.noise)
          if ((noise > 0.0) == (row == CloudRow::Noise)) addWhole("noise", noise, noise, 0.0, options_.num_points);
        break;
      case CloudRow::Scan:
        addScans(false);
        break;
      case CloudRow::Moved:
        addScans(true);
        break;
      case CloudRow::Crop:
        addCrops();
        break;
      case CloudRow::Sampling:
        addPatterns();
        break;
    }
  }

  const std::vector<CloudRecipe>& recipes() const { return recipes_; }

private:
  const TestCloudOptions& options_;
  std::vector<CloudRecipe> recipes_;
};

}  // namespace

std::vector<CloudRecipe> recipesFor(const TestCloudOptions& options) {
  RecipeList list(options);
  switch (options.sweep) {
    case Sweep::None:
      for (const CloudRow row : options.rows) list.addRow(row);
      break;
    case Sweep::Noise:
      for (const double noise : options.noise) list.addWhole("noise", noise, noise, 0.0, options.num_points);
      break;
    case Sweep::Points:
      for (const double count : options.point_counts) list.addWhole("points", count, 0.0, 0.0, static_cast<int>(count));
      break;
    case Sweep::Missing:
      for (const double share : options.missing) list.addWhole("missing", share, 0.0, share, options.num_points);
      break;
    case Sweep::Views:
      list.addScans(false);
      break;
  }
  return list.recipes();
}

TestCloudMaker::TestCloudMaker(const pcl::PolygonMesh& mesh, const std::string& key, const TestCloudOptions& options)
    : mesh_(mesh), options_(options), scanner_(mesh), seed_(RandomStream(options.seed, hashOf(key))()) {}

TestCloud TestCloudMaker::make(const CloudRecipe& recipe) const {
  return recipe.view < 0 ? makeWhole(recipe) : makeScan(recipe);
}

TestCloud TestCloudMaker::makeWhole(const CloudRecipe& recipe) const {
  TestCloud result;
  result.cloud = sample(recipe);
  result.T_cloud_model = randomPose(seedOf(seed_, kPose), scanner_.diagonal());
  result.T_cloud_model.translation() -= result.T_cloud_model.linear() * scanner_.center();
  RandomStream noise(seedOf(seed_, kNoise));
  for (pcl::PointXYZ& point : *result.cloud) {
    Eigen::Vector3d x = result.T_cloud_model * point.getVector3fMap().cast<double>();
    if (recipe.noise > 0.0)
      for (int k = 0; k < 3; ++k) x[k] += recipe.noise * scanner_.diagonal() * standardNormal(noise);
    point.getVector3fMap() = x.cast<float>();
  }
  if (recipe.missing > 0.0) {
    RandomStream random(seedOf(seed_, kCut));
    cut(*result.cloud, recipe.missing, result.T_cloud_model.linear() * randomDirection(random));
  }
  return result;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr TestCloudMaker::sample(const CloudRecipe& recipe) const {
  if (recipe.pattern == SamplingPattern::Even) return sampleMesh(mesh_, recipe.num_points, seedOf(seed_, kSampling));
  return samplePattern(mesh_, scanner_, recipe.pattern, recipe.num_points,
                       seedOf(seed_, kPattern, static_cast<std::uint64_t>(recipe.pattern)));
}

TestCloud TestCloudMaker::makeScan(const CloudRecipe& recipe) const {
  VirtualScannerOptions options;
  options.num_points = recipe.num_points;
  options.max_resolution = kMaxResolution;
  options.noise = recipe.noise;
  options.random_pose = true;
  options.seed = seedOf(seed_, kPose, static_cast<std::uint64_t>(recipe.view) + 1);
  const Eigen::Vector3d direction = viewDirection(recipe.view);
  const VirtualScan scan = scanner_.scan(direction, options);
  TestCloud result{
      scan.cloud, scan.T_scan_model,
      View{scan.T_scan_model.linear() * direction, scan.T_scan_sensor, std::tan(options.field_of_view / 2)}};
  if (recipe.ring_distance > 1) keepRings(*result.cloud, recipe.ring_distance);
  if (recipe.moved) {
    const std::uint64_t seed = seedOf(seed_, kMove, static_cast<std::uint64_t>(recipe.view) + 1);
    moveAndForgetViewpoint(result, randomPose(seed, scanner_.diagonal()), scan.T_scan_model * scanner_.center());
  }
  return result;
}

Eigen::Vector3d TestCloudMaker::viewDirection(int view) const {
  if (!options_.random_views) return cubeCorners()[static_cast<std::size_t>(view)];
  RandomStream random(seedOf(seed_, kView, static_cast<std::uint64_t>(view)));
  return randomDirection(random);
}

}  // namespace pcl_symmetry::apps
