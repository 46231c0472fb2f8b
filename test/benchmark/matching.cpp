/// What matching costs: the distance of two descriptors, and finding the nearest of many compact signatures, with the
/// share of queries whose true nearest is found: benchmark_matching [SHAPES], 904 and 100 000 by default.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/base/random.h"
#include "core/matching/symmetry_descriptor.h"
#include "core/geometry/axis_rotations.h"
#include "core/matching/compact_index.h"

namespace {

using namespace pcl_symmetry;

constexpr int kDimensions = 256, kNumQueries = 50;

/// Unit vectors whose components fall as those of compact signatures do.
Eigen::MatrixXf syntheticForms(int count, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXf forms = Eigen::MatrixXf::NullaryExpr(kDimensions, count, [&] {
    return static_cast<float>(random.uniform() + random.uniform() + random.uniform() - 1.5);
  });
  for (int d = 0; d < kDimensions; ++d) forms.row(d) *= static_cast<float>(std::pow(1.0 + d, -0.5));
  forms.colwise().normalize();
  return forms;
}

/// Calls body() \p count times.
/// \return the median of its time, milliseconds.
template <typename Body>
double medianTime(int count, const Body& body) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto start = std::chrono::steady_clock::now();
    body(i);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + count / 2, times.end());
  return times[static_cast<std::size_t>(count / 2)];
}

void measureDistance() {
  RandomStream random(1);
  std::vector<std::vector<float>> descriptors(64, std::vector<float>(kPRSTSize));
  for (auto& descriptor : descriptors)
    for (float& value : descriptor) value = static_cast<float>(random.uniform());
  float sum = 0.0f;
  constexpr int kRepeats = 1000;
  const double time = medianTime(21, [&](int) {
    for (int k = 0; k < kRepeats; ++k)
      sum += planeDescriptorDistance(descriptors[k % 64].data(), descriptors[(k + 1) % 64].data(), kPRSTSize);
  });
  std::printf("distance of two PRST, %d values: %.1f us (%g)\n", kPRSTSize, 1000.0 * time / kRepeats, sum);
}

/// Each query is a shape of the index with noise, and 23 other rotations.
void measureQueries(int num_shapes, double noise) {
  const Eigen::MatrixXf forms = syntheticForms(num_shapes, 1);
  const CompactIndex index(forms, 1);
  const Eigen::MatrixXf added = syntheticForms(kNumQueries, 2), others = syntheticForms(kNumAxisRotations, 3);
  std::vector<Eigen::MatrixXf> queries(kNumQueries, others);
  for (int i = 0; i < kNumQueries; ++i) {
    const auto shape = static_cast<Eigen::Index>(static_cast<long long>(i) * num_shapes / kNumQueries);
    queries[i].col(i % kNumAxisRotations) = (forms.col(shape) + static_cast<float>(noise) * added.col(i)).normalized();
  }
  std::vector<int> answers(kNumQueries);
  const double time = medianTime(kNumQueries, [&](int i) { answers[i] = index.nearest(queries[i], 10).front().first; });
  int found = 0;
  for (int i = 0; i < kNumQueries; ++i) {
    Eigen::Index nearest;
    (queries[i].transpose() * forms).colwise().maxCoeff().maxCoeff(&nearest);
    found += answers[i] == nearest ? 1 : 0;
  }
  std::printf("nearest of %d shapes, noise %.1f: %.2f ms, true nearest found %.2f\n", num_shapes, noise, time,
              static_cast<double>(found) / kNumQueries);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<int> sizes = argc > 1 ? std::vector<int>{std::atoi(argv[1])} : std::vector<int>{904, 100'000};
  if (sizes.front() < 1) {
    std::fprintf(stderr, "usage: benchmark_matching [SHAPES], SHAPES >= 1\n");
    return 2;
  }
  measureDistance();
  for (const int size : sizes)
    for (const double noise : {0.3, 0.6, 1.0}) measureQueries(size, noise);
  return 0;
}
