#include "evaluate/shared/test_clouds.h"

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
enum Stream : std::uint64_t { kSampling, kNoise, kCut, kPose, kView };

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

}  // namespace

std::vector<CloudRecipe> recipesFor(const TestCloudOptions& options) {
  std::vector<CloudRecipe> recipes;
  const auto whole = [&](const std::string& what, double x, double noise, double missing, int num_points) {
    recipes.push_back(
        {"whole, " + what + " " + shortest(x), "whole_" + what + "_" + shortest(x), x, num_points, noise, missing, -1});
  };
  const auto scans = [&] {
    const int num_views = options.random_views ? options.num_views : std::min(options.num_views, 8);
    for (const double noise : options.scan_noise) {
      for (int view = 0; view < num_views; ++view) {
        recipes.push_back({"scan, noise " + shortest(noise),
                           "scan_" + std::to_string(view) + "_noise_" + shortest(noise), noise, options.num_points,
                           noise, 0.0, view});
      }
    }
  };
  switch (options.sweep) {
    case Sweep::None:
      for (const double noise : options.noise) whole("noise", noise, noise, 0.0, options.num_points);
      scans();
      break;
    case Sweep::Noise:
      for (const double noise : options.noise) whole("noise", noise, noise, 0.0, options.num_points);
      break;
    case Sweep::Points:
      for (const double count : options.point_counts) whole("points", count, 0.0, 0.0, static_cast<int>(count));
      break;
    case Sweep::Missing:
      for (const double share : options.missing) whole("missing", share, 0.0, share, options.num_points);
      break;
    case Sweep::Views:
      scans();
      break;
  }
  return recipes;
}

TestCloudMaker::TestCloudMaker(const pcl::PolygonMesh& mesh, const std::string& key, const TestCloudOptions& options)
    : mesh_(mesh), options_(options), scanner_(mesh), seed_(RandomStream(options.seed, hashOf(key))()) {}

TestCloud TestCloudMaker::make(const CloudRecipe& recipe) const {
  return recipe.view < 0 ? makeWhole(recipe) : makeScan(recipe);
}

TestCloud TestCloudMaker::makeWhole(const CloudRecipe& recipe) const {
  TestCloud result;
  result.cloud = sampleMesh(mesh_, recipe.num_points, seedOf(seed_, kSampling));
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

TestCloud TestCloudMaker::makeScan(const CloudRecipe& recipe) const {
  VirtualScannerOptions options;
  options.num_points = recipe.num_points;
  options.max_resolution = kMaxResolution;
  options.noise = recipe.noise;
  options.random_pose = true;
  options.seed = seedOf(seed_, kPose, static_cast<std::uint64_t>(recipe.view) + 1);
  const Eigen::Vector3d direction = viewDirection(recipe.view);
  const VirtualScan scan = scanner_.scan(direction, options);
  return {scan.cloud, scan.T_scan_model, Eigen::Vector3d(scan.T_scan_model.linear() * direction)};
}

Eigen::Vector3d TestCloudMaker::viewDirection(int view) const {
  if (!options_.random_views) return cubeCorners()[static_cast<std::size_t>(view)];
  RandomStream random(seedOf(seed_, kView, static_cast<std::uint64_t>(view)));
  return randomDirection(random);
}

}  // namespace pcl_symmetry::apps
