/// Error of the estimators of the transform against the time that one thread takes (Figure 6): counters "rms_percent"
/// and "bias_percent" are those of PRST over planes of the 64^3 grid, against the full sum with exact distances.
/// error_against_time.py draws it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "models.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kNumBins = 64;  // of theta, phi and r

double prst(double d) {
  return std::sqrt(std::max(0.0, 0.5 * (1.0 + d)));
}

/// What the estimators of one model are compared with.
struct Reference {
  Points points;
  GaussianEdt edt;
  PlaneGrid grid;
  std::vector<std::size_t> bins;
  std::vector<double> at_centers;  ///< D at the centers of these bins
  std::vector<float> averages;     ///< D over each bin of the grid

  explicit Reference(const Model& model)
      : points(model.sample(10'000)),
        edt(points, GaussianEdtOptions()),
        grid(kNumBins, kNumBins, kNumBins, edt.center(), edt.radius()) {
    RandomStream random(3);
    for (int i = 0; i < 300; ++i) bins.push_back(random.below(grid.size()));
    sumAtCenters();
    // Averages: two by two by two bins in one, each at its center by convolution.
    const PlaneGrid fine(2 * kNumBins, 2 * kNumBins, 2 * kNumBins, edt.center(), edt.radius());
    const SymmetryMap map = convolutionTransform(edt, fine);
    averages.assign(grid.size(), 0.0f);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const PlaneGrid::Bin bin = fine.bin(i);
      averages[grid.index({bin.theta / 2, bin.phi / 2, bin.radius / 2})] += 0.125f * map[i];
    }
  }

  /// D(gamma) = sum over cells of f(x) f(gamma x) / sum f^2, with exact distances to the points.
  void sumAtCenters() {
    const auto search = makeFlannSearch(points);
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < edt.values().size(); ++i)
      if (edt.values()[i] > 0.0f) cells.push_back(i);
    at_centers.assign(bins.size(), 0.0);
    parallelBlocks(bins.size(), 0, [&](std::size_t p) {
      const ReflectionPlane plane = grid.plane(grid.bin(bins[p]));
      Points reflected(3, static_cast<Eigen::Index>(cells.size()));
      for (std::size_t i = 0; i < cells.size(); ++i)
        reflected.col(static_cast<Eigen::Index>(i)) = plane.reflect(edt.cellCenter(cells[i])).cast<float>();
      std::vector<int> indices;
      std::vector<float> sq_distances;
      search->search(reflected, 1, indices, sq_distances);
      for (std::size_t i = 0; i < cells.size(); ++i)
        at_centers[p] += edt.values()[cells[i]] * std::exp(-sq_distances[i] / (edt.sigma() * edt.sigma()));
      at_centers[p] /= edt.sqNorm();
    });
  }
};

const Reference& referenceOf(std::size_t model) {
  static std::map<std::size_t, Reference> references;
  return references.try_emplace(model, models()[model]).first->second;
}

/// Argument 0 is the setting, argument 1 the model.
void run(benchmark::State& state, const std::function<SymmetryMap(const Reference&)>& estimate) {
  const auto model = static_cast<std::size_t>(state.range(1));
  const Reference& reference = referenceOf(model);
  SymmetryMap map;
  for (auto _ : state) map = estimate(reference);
  double sq_sum = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < reference.bins.size(); ++i) {
    const double error = map.prst(reference.bins[i]) - prst(reference.at_centers[i]);
    sq_sum += error * error;
    sum += error;
  }
  const auto num = static_cast<double>(reference.bins.size());
  state.SetLabel(models()[model].name);
  state.counters["rms_percent"] = 100.0 * std::sqrt(sq_sum / num);
  state.counters["bias_percent"] = 100.0 * sum / num;
  // Voting estimates averages over bins, and is judged by them; pooled: those of two by two by two bins in one.
  for (const int width : {1, 2}) {
    const std::size_t num_bins = kNumBins / width;
    std::vector<double> estimated(num_bins * num_bins * num_bins), expected(estimated.size());
    for (std::size_t i = 0; i < map.values.size(); ++i) {
      const PlaneGrid::Bin bin = map.grid.bin(i);
      const std::size_t pool = (bin.theta / width * num_bins + bin.phi / width) * num_bins + bin.radius / width;
      estimated[pool] += map[i] / (width * width * width);
      expected[pool] += reference.averages[i] / (width * width * width);
    }
    std::vector<double> errors;
    double sq_errors = 0.0;
    for (std::size_t i = 0; i < estimated.size(); ++i) {
      errors.push_back(std::abs(prst(estimated[i]) - prst(expected[i])));
      sq_errors += errors.back() * errors.back();
    }
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    const std::string name = width == 1 ? "of_averages_percent" : "of_pooled_percent";
    state.counters["rms_" + name] = 100.0 * std::sqrt(sq_errors / static_cast<double>(errors.size()));
    state.counters["median_" + name] = 100.0 * errors[errors.size() / 2];
  }
}

void Error_sampled(benchmark::State& state) {
  SampledTransformOptions options;
  options.num_threads = 1;
  options.num_samples = static_cast<int>(state.range(0));
  run(state, [&](const Reference& reference) { return sampledTransform(reference.edt, reference.grid, options); });
}
void Error_convolution(benchmark::State& state) {
  ConvolutionTransformOptions options;
  options.num_threads = 1;
  options.spacing = 0.01 * static_cast<double>(state.range(0));
  run(state, [&](const Reference& reference) { return convolutionTransform(reference.edt, reference.grid, options); });
}
void Error_rotational(benchmark::State& state) {
  RotationalTransformOptions options;
  options.num_threads = 1;
  options.refined_share = 0.01 * static_cast<double>(state.range(0));
  run(state, [&](const Reference& reference) { return rotationalTransform(reference.edt, reference.grid, options); });
}
void vote(benchmark::State& state, double near_distance) {
  VotingTransformOptions options;
  options.num_threads = 1;
  options.num_pairs = state.range(0);
  options.near_distance = near_distance;
  run(state, [&](const Reference& reference) { return votingTransform(reference.edt, reference.grid, options); });
}
void Error_voting(benchmark::State& state) {
  vote(state, VotingTransformOptions().near_distance);
}
void Error_voting_as_published(benchmark::State& state) {
  vote(state, 0.0);
}

#define ESTIMATOR(name, setting, ...) \
  BENCHMARK(name)->ArgNames({setting, "model"})->ArgsProduct({__VA_ARGS__})->Unit(benchmark::kMillisecond)
ESTIMATOR(Error_sampled, "samples", {32, 64, 128, 256, 512, 1024, 2048, 4096}, {0, 1, 2, 3, 4});
ESTIMATOR(Error_convolution, "spacing_percent", {100, 90, 70, 50}, {0, 1, 2, 3, 4});
ESTIMATOR(Error_rotational, "refined_percent", {100, 10}, {0, 1, 2, 3, 4});
ESTIMATOR(Error_voting, "pairs", {200'000, 2'000'000, 20'000'000}, {0, 1, 2, 3, 4});
ESTIMATOR(Error_voting_as_published, "pairs", {200'000, 2'000'000, 20'000'000}, {0, 1, 2, 3, 4});

}  // namespace

BENCHMARK_MAIN();
