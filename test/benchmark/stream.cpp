/// A stream of clouds: benchmark_stream [CLOUDS] [THREADS], 1000 clouds and one thread per core by default. Each of
/// 10 000 points of one of five models, in a random pose. Prints how many clouds a second are done, how much processor
/// time one takes, and whether the memory of the process grows.
#include <sys/resource.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "core/base/random.h"
#include "models.h"
#include "pcl_symmetry/core/plane_detection.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kNumPoints = 10'000;

Eigen::Isometry3f randomPose(std::uint64_t seed) {
  RandomStream random(seed);
  const auto symmetric = [&] { return static_cast<float>(2.0 * random.uniform() - 1.0); };
  const Eigen::Quaternionf q(symmetric(), symmetric(), symmetric(), symmetric());
  return Eigen::Translation3f(symmetric(), symmetric(), symmetric()) * q.normalized();
}

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Processor time of all threads, seconds.
double processorSeconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
}

double peakMegabytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The page faults of the process: memory that was asked of the system again.
long numPageFaults() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

}  // namespace

int main(int argc, char** argv) {
  const long num_clouds = argc > 1 ? std::atol(argv[1]) : 1000;
  DetectionOptions options;
  options.num_threads = argc > 2 ? std::atoi(argv[2]) : 0;
  if (num_clouds < 10 || options.num_threads < 0) {
    std::fprintf(stderr, "usage: benchmark_stream [CLOUDS] [THREADS], CLOUDS >= 10, THREADS >= 0 (0: one per core)\n");
    return 2;
  }
  const char* folder = std::getenv("PCL_SYMMETRY_MODELS");
  std::vector<Points> clouds;
  for (const Model& model : fiveModels(folder ? folder : "")) clouds.push_back(model.sample(kNumPoints));
  std::size_t num_done = 0, num_planes = 0;
  double early_megabytes = 0.0;
  long early_faults = 0;
  const auto cloud = [&](std::size_t i) -> Points {
    const Eigen::Isometry3f pose = randomPose(i + 1);
    return (pose.linear() * clouds[i % clouds.size()]).colwise() + pose.translation();
  };
  const auto found = [&](std::size_t, const Detection& detection) {
    num_planes += detection.planes.size();
    if (++num_done != static_cast<std::size_t>(num_clouds) / 10) return;
    early_megabytes = peakMegabytes();
    early_faults = numPageFaults();
  };
  const double processor_before = processorSeconds();
  const auto start = std::chrono::steady_clock::now();
  detectPlanesOfMany(static_cast<std::size_t>(num_clouds), cloud, found, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double processor = (processorSeconds() - processor_before) / static_cast<double>(num_clouds);
  std::printf(
      "%ld clouds of %d points: %.1f a second, %.1f ms of processor time each (%.1f a second and core), %zu planes\n",
      num_clouds, kNumPoints, static_cast<double>(num_clouds) / seconds, 1e3 * processor, 1.0 / processor, num_planes);
  std::printf("peak memory %.1f MB after a tenth of them, %.1f MB at the end; %.0f page faults each after that tenth\n",
              early_megabytes, peakMegabytes(),
              static_cast<double>(numPageFaults() - early_faults) / (0.9 * static_cast<double>(num_clouds)));
  return 0;
}
