/// Time and peak memory from a large cloud in memory to its planes: benchmark_large_cloud [POINTS], 10 million by
/// default.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "core/base/random.h"
#include "pcl_symmetry/symmetry_detection.h"

namespace {

/// Points on the faces of a box of 1 x 0.7 x 0.45.
pcl::PointCloud<pcl::PointXYZ> boxCloud(std::size_t num_points) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.resize(num_points);
  pcl_symmetry::RandomStream random(1);
  const Eigen::Vector3f size(1.0f, 0.7f, 0.45f);
  for (pcl::PointXYZ& point : cloud) {
    Eigen::Vector3f p(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    const auto face = random.below(3);
    p[face] = p[face] > 0.0f ? 0.5f : -0.5f;
    point.getVector3fMap() = p.cwiseProduct(size);
  }
  return cloud;
}

double peakMegabytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

}  // namespace

int main(int argc, char** argv) {
  const long long num_points = argc > 1 ? std::atoll(argv[1]) : 10'000'000;
  if (num_points < 100) {
    std::fprintf(stderr, "usage: benchmark_large_cloud [POINTS], POINTS >= 100\n");
    return 2;
  }
  const auto cloud = boxCloud(static_cast<std::size_t>(num_points));
  const double cloud_megabytes = static_cast<double>(cloud.size() * sizeof(pcl::PointXYZ)) / (1024.0 * 1024.0);
  const auto start = std::chrono::steady_clock::now();
  const auto planes = pcl_symmetry::detectSymmetryPlanes(cloud);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%lld points, %.0f MB: %zu planes in %.2f s, peak memory of the process %.0f MB\n", num_points,
              cloud_megabytes, planes.size(), seconds, peakMegabytes());
  return planes.size() == 3 ? 0 : 1;
}
