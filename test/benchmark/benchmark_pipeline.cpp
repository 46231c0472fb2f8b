/// Cost of each stage, and from a cloud to its planes, against points, grid size and threads.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>

#include "core/base/random.h"
#include "models.h"
#include "pcl_symmetry/core/plane_detection.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kManyPoints = 10'000;

/// The models of the folder in PCL_SYMMETRY_MODELS, or the synthetic ones.
const std::vector<Model>& models() {
  static const std::vector<Model> models = [] {
    const char* folder = std::getenv("PCL_SYMMETRY_MODELS");
    return fiveModels(folder ? folder : "");
  }();
  return models;
}

const Points& cloud(int model, int num_points) {
  static std::map<std::pair<int, int>, Points> clouds;
  auto& points = clouds[{model, num_points}];
  if (points.cols() == 0) points = models()[model].sample(num_points);
  return points;
}

GaussianEdtOptions edtOptions(int num_cells, int num_threads) {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  options.num_threads = num_threads;
  return options;
}

/// Arguments: points, cells, threads (0 = all).
void BM_GaussianEdt(benchmark::State& state) {
  const Points& points = cloud(0, static_cast<int>(state.range(0)));
  const auto options = edtOptions(static_cast<int>(state.range(1)), static_cast<int>(state.range(2)));
  for (auto _ : state) benchmark::DoNotOptimize(GaussianEdt(points, options).sum());
}

/// Arguments: cells and bins along each side, samples, threads.
void BM_SampledTransform(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  const GaussianEdt edt(cloud(0, kManyPoints), edtOptions(size, 0));
  const PlaneGrid grid(size, size, size, edt.center(), edt.radius());
  SampledTransformOptions options;
  options.num_samples = static_cast<int>(state.range(1));
  options.num_threads = static_cast<int>(state.range(2));
  for (auto _ : state) benchmark::DoNotOptimize(sampledTransform(edt, grid, options).values.data());
}

/// Arguments: cells and bins along each side, threads.
void BM_ConvolutionTransform(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  const GaussianEdt edt(cloud(0, kManyPoints), edtOptions(size, 0));
  const PlaneGrid grid(size, size, size, edt.center(), edt.radius());
  ConvolutionTransformOptions options;
  options.num_threads = static_cast<int>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(convolutionTransform(edt, grid, options).values.data());
}

/// From points to planes, everything but reading; the stages as counters in milliseconds.
void detect(benchmark::State& state, const Points& points, const DetectionOptions& options) {
  std::map<std::string, double> stages;
  std::size_t num_planes = 0;
  for (auto _ : state) {
    const Detection detection = detectPlanes(points, options);
    for (const auto& [stage, milliseconds] : detection.timing_ms) stages[stage] += milliseconds;
    num_planes = detection.planes.size();
  }
  for (const auto& [stage, milliseconds] : stages)
    state.counters[stage] = milliseconds / static_cast<double>(state.iterations());
  state.counters["planes"] = static_cast<double>(num_planes);
}

/// Arguments: points, cells, threads.
void BM_Detection(benchmark::State& state) {
  DetectionOptions options;
  options.edt = edtOptions(static_cast<int>(state.range(1)), static_cast<int>(state.range(2)));
  options.num_threads = options.edt.num_threads;
  detect(state, cloud(0, static_cast<int>(state.range(0))), options);
}

/// Argument: model.
void BM_CloudToPlanes(benchmark::State& state) {
  const int model = static_cast<int>(state.range(0));
  state.SetLabel(models()[model].name);
  detect(state, cloud(model, kManyPoints), {});
}

/// The most planes that a convex body of flat faces usually has: nine, each of which is refined on all points.
void BM_CubeToPlanes(benchmark::State& state) {
  Points points(3, kManyPoints);
  RandomStream random(1);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (int axis = 0; axis < 3; ++axis) points(axis, i) = static_cast<float>(2.0 * random.uniform() - 1.0);
    float& across = points(static_cast<Eigen::Index>(random.below(3)), i);
    across = across < 0.0f ? -1.0f : 1.0f;
  }
  detect(state, points, {});
}

BENCHMARK(BM_GaussianEdt)
    ->ArgNames({"points", "cells", "threads"})
    ->ArgsProduct({{1'000, 10'000, 100'000, 1'000'000}, {64}, {0}})
    ->ArgsProduct({{10'000}, {32, 128}, {0}})
    ->Args({10'000, 64, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_SampledTransform)
    ->ArgNames({"size", "samples", "threads"})
    ->ArgsProduct({{32, 64, 128}, {128}, {0}})
    ->ArgsProduct({{64}, {64, 1024}, {0}})
    ->Args({64, 128, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_ConvolutionTransform)
    ->ArgNames({"size", "threads"})
    ->ArgsProduct({{32, 64}, {0}})
    ->Args({64, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_Detection)
    ->ArgNames({"points", "cells", "threads"})
    ->ArgsProduct({{1'000, 10'000, 100'000, 1'000'000}, {64}, {0}})
    ->ArgsProduct({{10'000}, {32, 128}, {0}})
    ->Args({10'000, 64, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_CubeToPlanes)->Unit(benchmark::kMillisecond)->UseRealTime();

BENCHMARK(BM_CloudToPlanes)->ArgName("model")->DenseRange(0, 4)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
