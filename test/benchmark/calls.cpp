/// The time of a call of detectPlanes(): benchmark_calls FILE CALLS. FILE holds rows of three float32 numbers. Prints
/// the median of CALLS calls in milliseconds of wall time. python_calls.py compares it with that of a call from Python.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "pcl_symmetry/core/plane_detection.h"

namespace {

using namespace pcl_symmetry;

/// The median wall time of a call, milliseconds. The first call, which starts the threads, is left out.
double medianMilliseconds(const Points& points, int num_calls) {
  std::vector<double> times;
  for (int call = 0; call <= num_calls; ++call) {
    const auto start = std::chrono::steady_clock::now();
    const Detection detection = detectPlanes(points);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    if (call > 0) times.push_back(taken.count());
  }
  std::nth_element(times.begin(), times.begin() + num_calls / 2, times.end());
  return times[static_cast<std::size_t>(num_calls) / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const int num_calls = argc == 3 ? std::atoi(argv[2]) : 0;
  if (num_calls < 1) {
    std::fprintf(stderr, "usage: benchmark_calls FILE CALLS, FILE: rows of three float32 numbers, CALLS >= 1\n");
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty() || bytes.size() % (3 * sizeof(float)) != 0) {
    std::fprintf(stderr, "%s: no rows of three float32 numbers\n", argv[1]);
    return 1;
  }
  Points points(3, static_cast<Eigen::Index>(bytes.size() / (3 * sizeof(float))));
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(points.data()));
  std::printf("%.3f\n", medianMilliseconds(points, num_calls));
}
