#include "evaluate/clouds/sampling_pattern.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "common/scanner/random_numbers.h"
#include "core/base/random.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Points of a dense sample for each wanted one. chosen: half repeats the even spread, twice changes no figure.
constexpr int kDensity = 20;
/// Rows of a picture of which one is kept. chosen: lines lie eight spacings apart; a LiDAR has four to ten.
constexpr int kRowsOfRing = 8;
/// Pictures hold so many points for each that is kept of them. chosen: half leaves too few where pictures overlap.
constexpr int kSpare = 2;
/// Halvings of the interval of the edge of a voxel. derived: 2^-20 of the diagonal, below any spacing.
constexpr int kMaxHalvings = 20;
constexpr double kAcceptedCountError = 0.02;  // share of the points; chosen: half takes one halving more

/// Keeps num_points of the points, drawn at random, in their order.
void thin(Cloud& cloud, int num_points, std::uint64_t seed) {
  RandomStream random(seed, 0);
  Cloud kept;
  auto needed = static_cast<double>(num_points), left = static_cast<double>(cloud.size());
  for (const pcl::PointXYZ& point : cloud) {
    if (uniform(random) * left < needed) {
      kept.push_back(point);
      needed -= 1.0;
    }
    left -= 1.0;
  }
  cloud = kept;
}

/// \return the means of the points in each cell of the given edge, in the order in which the cells are first met.
Cloud cellMeans(const Cloud& dense, float edge) {
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
  };
  std::unordered_map<std::uint64_t, std::size_t> index_of_key;
  std::vector<Cell> cells;
  for (const pcl::PointXYZ& point : dense) {
    constexpr std::int64_t kBits = 21, kHalf = std::int64_t{1} << (kBits - 1);  // derived: three cells fit 64 bits
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k)
      key = (key << kBits) |
            static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(point.data[k] / edge)) + kHalf);
    const auto [entry, is_new] = index_of_key.emplace(key, cells.size());
    if (is_new) cells.emplace_back();
    Cell& cell = cells[entry->second];
    cell.sum += point.getVector3fMap().cast<double>();
    ++cell.count;
  }
  Cloud means;
  for (const Cell& cell : cells) {
    const Eigen::Vector3f mean = (cell.sum / cell.count).cast<float>();
    means.push_back(pcl::PointXYZ(mean.x(), mean.y(), mean.z()));
  }
  return means;
}

/// Looks for the edge of the cells by halving.
Cloud sampleVoxels(const Cloud& dense, double diagonal, int num_points) {
  double low = 0.0, high = diagonal;
  Cloud means = dense;
  for (int i = 0; i < kMaxHalvings; ++i) {
    const double edge = 0.5 * (low + high);
    means = cellMeans(dense, static_cast<float>(edge));
    const double error = static_cast<double>(means.size()) / num_points - 1.0;
    if (std::abs(error) < kAcceptedCountError) break;
    (error > 0.0 ? low : high) = edge;
  }
  return means;
}

/// \param rows keeps one row of this number.
Cloud scanAround(const VirtualScanner& scanner, int num_points, int rows, std::uint64_t seed) {
  const Eigen::Matrix3d turn = randomPose(seed, 0.0).linear();
  VirtualScannerOptions options;
  const auto corners = cubeCorners();
  options.num_points = std::max<int>(1, kSpare * rows * num_points / static_cast<int>(corners.size()));
  Cloud all;
  for (const Eigen::Vector3d& corner : corners) {
    const VirtualScan scan = scanner.scan(turn * corner, options);
    for (std::uint32_t row = 0; row < scan.cloud->height; row += rows) {
      for (std::uint32_t column = 0; column < scan.cloud->width; ++column) {
        const pcl::PointXYZ& point = scan.cloud->at(column, row);
        if (point.getVector3fMap().allFinite()) all.push_back(point);
      }
    }
  }
  return all;
}

}  // namespace

const char* toString(SamplingPattern pattern) {
  switch (pattern) {
    case SamplingPattern::Random:
      return "random";
    case SamplingPattern::Voxel:
      return "voxel";
    case SamplingPattern::Scanners:
      return "scanners";
    case SamplingPattern::Rings:
      return "rings";
    default:
      return "even";
  }
}

Cloud::Ptr samplePattern(const pcl::PolygonMesh& mesh, const VirtualScanner& scanner, SamplingPattern pattern,
                         int num_points, std::uint64_t seed) {
  Cloud::Ptr cloud(new Cloud);
  switch (pattern) {
    case SamplingPattern::Even:
      return sampleMesh(mesh, num_points, seed);
    case SamplingPattern::Random:
      cloud = sampleMesh(mesh, kDensity * num_points, seed);
      thin(*cloud, num_points, seed);
      break;
    case SamplingPattern::Voxel:
      *cloud = sampleVoxels(*sampleMesh(mesh, kDensity * num_points, seed), scanner.diagonal(), num_points);
      break;
    case SamplingPattern::Scanners:
      *cloud = scanAround(scanner, num_points, 1, seed);
      thin(*cloud, num_points, seed);
      break;
    case SamplingPattern::Rings: {
      *cloud = scanAround(scanner, num_points, kRowsOfRing, seed);
      thin(*cloud, num_points, seed);
      break;
    }
  }
  return cloud;
}

}  // namespace pcl_symmetry::apps
