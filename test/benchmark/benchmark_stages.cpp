/// Time of each stage and each task. A counter "needs_STEP" is the number of steps, of the kinds that
/// benchmark_machine.cpp measures, that the result needs at least whatever the algorithm: roofline.py makes a table of
/// both.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "animal.h"
#include "core/base/random.h"
#include "core/geometry/directions.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "core/matching/view_code.h"
#include "core/registration/pose_scoring.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kManyPoints = 10'000;  // what the tools spread over a mesh
constexpr int kCells = 64;           // along each side: the default

const Points& cloud(int num_points = kManyPoints) {
  static std::map<int, Points> clouds;
  Points& points = clouds[num_points];
  if (points.cols() == 0) points = animal().sample(num_points);
  return points;
}

struct Scan {
  Eigen::Vector3d viewpoint;
  Points points;
};
const Scan& animalScan() {
  static const Scan scan = [] {
    const BoundingBall ball = boundingBall(cloud());
    const Eigen::Vector3d from = ball.center + 4.0 * ball.radius * Eigen::Vector3d(0.6, 0.5, 0.62).normalized();
    return Scan{from, animal().scan(4 * kManyPoints, from)};
  }();
  return scan;
}

void needs(benchmark::State& state, const std::string& step, double count) {
  state.counters["needs_" + step] += count;
}

GaussianEdtOptions edtOptions(int num_threads, int num_cells = kCells) {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  options.num_threads = num_threads;
  return options;
}

DetectionOptions detectionOptions(int num_threads) {
  DetectionOptions options;
  options.num_cells = kCells;
  options.num_threads = num_threads;
  return options;
}

/// f at the cells near the points; the whole table is written, sharpened and written again.
void needsTransform(benchmark::State& state, const GaussianEdt& edt) {
  const auto num_near = std::count_if(edt.values().begin(), edt.values().end(), [](float f) { return f > 0.0f; });
  needs(state, "exponential", static_cast<double>(num_near));
  needs(state, "byte_near", 3.0 * 4.0 * static_cast<double>(edt.values().size()));
}

/// The look-ups of one-point sampling: a sample counts where its image lies in the ball of cells.
void needsMap(benchmark::State& state, const Points& points, const GaussianEdt& edt, const PlaneGrid& grid,
              int num_samples) {
  double count = 0.0;
  for (std::size_t d = 0; d < grid.numDirections(); ++d) {
    for (int i = 0; i < num_samples; ++i) {
      const Eigen::Vector3d x = points.col(i * points.cols() / num_samples).cast<double>() - edt.center();
      const double along = grid.normal(d).dot(x);
      const double sq_half_chord = edt.radius() * edt.radius() - x.squaredNorm() + along * along;
      // Images lie at 2 r - along on the line through x.
      count += std::min<double>(grid.numRadius(), std::sqrt(std::max(0.0, sq_half_chord)) / grid.radiusStep());
    }
  }
  needs(state, "look_up", count);
}

/// The map of the default grid, normals, and for each plane the counterpart of each point and D.
void needsDetection(benchmark::State& state, const Points& points, std::size_t num_planes, int num_maps = 1) {
  const DetectionOptions options;
  const GaussianEdt edt(points, edtOptions(1));
  const PlaneGrid grid(options.expert, edt.center(), edt.radius());
  needsTransform(state, edt);
  for (int i = 0; i < num_maps; ++i) needsMap(state, points, edt, grid, options.expert.num_samples);
  needs(state, "nine_nearest", static_cast<double>(points.cols()));
  needs(state, "nearest", static_cast<double>(num_planes) * static_cast<double>(points.cols()));
  needs(state, "trilinear", static_cast<double>(num_planes) * state.counters["needs_exponential"]);
}

/// Arguments: points, cells, threads.
void Edt(benchmark::State& state) {
  const Points& points = cloud(static_cast<int>(state.range(0)));
  const auto options = edtOptions(static_cast<int>(state.range(2)), static_cast<int>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(GaussianEdt(points, options).sum());
  needsTransform(state, GaussianEdt(points, options));
}

/// Arguments: bins of theta, phi and r, samples, threads.
void Sampled(benchmark::State& state) {
  const GaussianEdt edt(cloud(), edtOptions(0));
  const PlaneGrid grid(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 64, edt.center(),
                       edt.radius());
  SampledTransformOptions options;
  options.num_samples = static_cast<int>(state.range(2));
  options.num_threads = static_cast<int>(state.range(3));
  for (auto _ : state) benchmark::DoNotOptimize(sampledTransform(edt, grid, options).values.data());
  needsMap(state, cloud(), edt, grid, options.num_samples);
}

/// Argument: threads. 64^3 planes.
void Convolution(benchmark::State& state) {
  const GaussianEdt edt(cloud(), edtOptions(0));
  const PlaneGrid grid(kCells, kCells, kCells, edt.center(), edt.radius());
  ConvolutionTransformOptions options;
  options.num_threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(convolutionTransform(edt, grid, options).values.data());
}

/// The least time of each stage, and what a process takes at most, stand in counters.
void detect(benchmark::State& state, const Points& points, const DetectionOptions& options,
            const Visibility* seen = nullptr) {
  std::map<std::string, double> stages;
  std::size_t num_planes = 0;
  for (auto _ : state) {
    const Detection detection = detectPlanes({points, seen}, options);
    for (const auto& [stage, milliseconds] : detection.timing_ms)
      stages[stage] = std::min(stages.emplace(stage, milliseconds).first->second, milliseconds);
    num_planes = detection.planes.size();
  }
  for (const auto& [stage, milliseconds] : stages) state.counters["ms_" + stage] = milliseconds;
  state.counters["planes"] = static_cast<double>(num_planes);
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  needsDetection(state, points, num_planes, seen ? 2 : 1);
}

/// Arguments: points, threads.
void Planes(benchmark::State& state) {
  detect(state, cloud(static_cast<int>(state.range(0))), detectionOptions(static_cast<int>(state.range(1))));
}
/// Arguments: rotations about axes are looked for, threads.
void PlanesOfScan(benchmark::State& state) {
  const std::optional<Visibility> seen = Visibility::fromPoints(animalScan().points, animalScan().viewpoint);
  DetectionOptions options = detectionOptions(static_cast<int>(state.range(1)));
  options.rotations = state.range(0) != 0;
  detect(state, animalScan().points, options, &*seen);
}
/// Nine planes, the most that a convex body of flat faces usually has. Argument: threads.
void PlanesOfCube(benchmark::State& state) {
  Points points(3, kManyPoints);
  RandomStream random(1);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (int axis = 0; axis < 3; ++axis) points(axis, i) = static_cast<float>(2.0 * random.uniform() - 1.0);
    float& across = points(static_cast<Eigen::Index>(random.below(3)), i);
    across = across < 0.0f ? -1.0f : 1.0f;
  }
  detect(state, points, detectionOptions(static_cast<int>(state.range(0))));
}

/// Argument: threads.
void Rotations(benchmark::State& state) {
  ObjectSymmetryOptions options;
  options.num_threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(objectSymmetries(cloud(), options));
  needsTransform(state, GaussianEdt(cloud(), edtOptions(1)));
  // Four prime orders about each direction at 48 points; one rotation is judged on all points.
  needs(state, "trilinear", 4.0 * 48.0 * options.num_directions);
  needs(state, "nine_nearest", static_cast<double>(cloud().cols()));
  needs(state, "nearest", static_cast<double>(cloud().cols()));
}

/// Argument: threads.
void Description(benchmark::State& state) {
  DescriptionOptions options;
  options.num_threads = static_cast<int>(state.range(0));
  const Points &points = cloud(options.max_points), &frame_points = cloud();
  for (auto _ : state) benchmark::DoNotOptimize(describeShape(points, options));
  const GaussianEdt edt(frame_points, edtOptions(1));
  const FrameOptions frame;
  needsTransform(state, edt);
  needsMap(state, frame_points, edt, PlaneGrid(frame, edt.center(), edt.radius()), frame.num_samples);
  // Each point counts in eight cells of two signatures, with six numbers.
  needs(state, "byte_near", 2.0 * 8.0 * 6.0 * 4.0 * static_cast<double>(points.cols()));
}

/// A mesh of 57 600 triangles. Argument: threads.
void Segmentation(benchmark::State& state) {
  std::vector<std::vector<int>> faces;
  for (const Eigen::Vector3i& triangle : animal().triangles)
    faces.push_back({triangle.x(), triangle.y(), triangle.z()});
  const SurfaceGraph graph = meshGraph(animal().vertices, faces);
  SegmentationOptions options;
  options.num_threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(segmentSurface(graph, options));
  state.counters["faces"] = static_cast<double>(faces.size());
  needsDetection(state, graph.centers, 1);
}

/// The pose of a whole cloud. Argument: threads.
void Registration(benchmark::State& state) {
  const BoundingBall ball = boundingBall(cloud());
  const Points points = normalizePoints(cloud(), ball.center, ball.radius);
  const Points turned = Eigen::AngleAxisf(1.0f, Eigen::Vector3f(1.0f, 2.0f, 3.0f).normalized()) * points;
  PoseSearchOptions options;
  options.num_threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const PosedSurface scan(turned, std::nullopt, 1, options.num_threads);
    const PosedSurface target(points, std::nullopt, 1, options.num_threads);
    benchmark::DoNotOptimize(searchPoses(scan, target, {}, options));
  }
  needs(state, "nine_nearest", 2.0 * kManyPoints);
  needs(state, "nearest", kManyPoints);
}

/// Two descriptors compared (Section 5.2). Argument: their numbers.
void DescriptorDistance(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const std::vector<float> a(size, 0.25f), b(size, 0.5f);
  for (auto _ : state) benchmark::DoNotOptimize(planeDescriptorDistance(a.data(), b.data(), size));
  needs(state, "byte_near", 2.0 * sizeof(float) * static_cast<double>(size));
}

/// The nearest views of 815 models. Argument: threads.
void NearestViews(benchmark::State& state) {
  constexpr int kNumModels = 815, kNumViews = 80;
  RandomStream random(4);
  const auto randomCode = [&] {
    ViewCode code;
    for (auto& value : code.values) value = static_cast<std::int8_t>(static_cast<int>(random.below(255)) - 127);
    code.size = static_cast<std::int16_t>(random.below(1000));
    return code;
  };
  ViewCodeIndex index;
  for (int model = 0; model < kNumModels; ++model) {
    std::vector<ViewCode> codes(kNumViews);
    for (ViewCode& code : codes) code = randomCode();
    index.add(packedViewCodes(codes));
  }
  const ViewCode query = randomCode();
  for (auto _ : state) benchmark::DoNotOptimize(index.nearest(query, 50, static_cast<int>(state.range(0))).data());
  needs(state, "byte_near", static_cast<double>(kNumModels) * kNumViews * (kViewCodeSize + 2));
}

// "Time" is that of the clock, "CPU" the processor time of all threads.
#define STAGE(name) BENCHMARK(name)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()
STAGE(Edt)->ArgNames({"points", "cells", "threads"})->ArgsProduct({{10'000, 1'000'000}, {kCells}, {1, 2}});
STAGE(Sampled)->ArgNames({"theta", "phi", "samples", "threads"})->ArgsProduct({{64}, {64}, {64, 512, 2048}, {1, 2}});
STAGE(Sampled)->ArgNames({"theta", "phi", "samples", "threads"})->Args({32, 128, 64, 1});
STAGE(Convolution)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(Planes)->ArgNames({"points", "threads"})->ArgsProduct({{1'000, 10'000, 100'000, 1'000'000, 10'000'000}, {1, 2}});
STAGE(PlanesOfScan)->ArgNames({"rotations", "threads"})->ArgsProduct({{0, 1}, {1, 2}});
STAGE(PlanesOfCube)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(Rotations)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(Description)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(Segmentation)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(Registration)->ArgName("threads")->Arg(1)->Arg(2);
STAGE(DescriptorDistance)->ArgName("size")->Arg(kPRSDSize)->Arg(kPRSTSize);
STAGE(NearestViews)->ArgName("threads")->Arg(1);

}  // namespace

BENCHMARK_MAIN();
