#include "speed/roofline_stages.h"

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/random.h"
#include "core/detection/candidates.h"
#include "core/detection/plane_judge.h"
#include "core/detection/staged_refinement.h"
#include "core/transform/edt_samples.h"
#include "core/matching/shape_description.h"
#include "core/registration/ranked_poses.h"
#include "core/matching/view_code_index.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/surface_segmentation.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "speed/processor_time.h"

namespace pcl_symmetry::benchmarks {

namespace {

constexpr int kNumPoints = 10'000;  // of every cloud. derived: the default of the tools
constexpr int kCells = 64;          // along each side. derived: the default

Work workOf(std::initializer_list<std::pair<Step, double>> steps) {
  Work work{};
  for (const auto& [step, count] : steps) work[static_cast<std::size_t>(step)] += count;
  return work;
}

Work operator+(Work a, const Work& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

/// Counts the queries that a computation asks.
class CountingSearch : public ClosestPointSearch {
public:
  explicit CountingSearch(const PointsRef& points) : search_(makeTreeSearch(points)) {}

  void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    (num_neighbours > 1 ? num_nine : num_nearest) += static_cast<std::int64_t>(queries.cols());
    search_->search(queries, num_neighbours, indices, sq_distances);
  }
  void searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                    std::vector<float>& sq_distances) const override {
    num_nearest += static_cast<std::int64_t>(queries.cols());
    search_->searchWithin(queries, max_sq_distance, indices, sq_distances);
  }

  /// \return the queries since the last call.
  Work lap() const {
    return workOf({{Step::Nearest, static_cast<double>(num_nearest.exchange(0))},
                   {Step::NineNearest, static_cast<double>(num_nine.exchange(0))}});
  }

private:
  Ptr search_;
  mutable std::atomic<std::int64_t> num_nearest{0}, num_nine{0};
};

/// The look-ups of a transform: a sample counts where its image lies in the ball of cells.
double numLookUps(const GaussianEdt& edt, const PlaneGrid& grid, int num_samples) {
  const Eigen::Matrix3Xf samples = drawPoints(edt, num_samples, 1, 1);
  const double radius = 0.5 * (edt.numCells() - 1) - 0.5;
  double count = 0.0;
  for (std::size_t d = 0; d < grid.numDirections(); ++d) {
    const Eigen::Vector3d n = grid.normal(d);
    for (Eigen::Index i = 0; i < samples.cols(); ++i) {
      const Eigen::Vector3d x = samples.col(i).cast<double>().array() - 0.5 * (edt.numCells() - 1);
      const double along = n.dot(x),
                   chord = std::sqrt(std::max(0.0, radius * radius - x.squaredNorm() + along * along));
      // Images lie at 2 r - along on the line through x.
      count += std::min<double>(grid.numRadius(), chord * edt.cellSize() / grid.radiusStep());
    }
  }
  return count;
}

/// f at the cells near the points, and the whole table written, sharpened and written again.
Work workOfTransform(const GaussianEdt& edt) {
  double num_near = 0.0;
  for (const float value : edt.values()) num_near += value > 0.0f ? 1.0 : 0.0;
  return workOf(
      {{Step::Exponential, num_near}, {Step::ByteNear, 3.0 * 4.0 * static_cast<double>(edt.values().size())}});
}

DetectionOptions oneThread() {
  DetectionOptions options;
  options.num_threads = options.edt.num_threads = 1;
  return options;
}

/// D of a plane: a value between eight for each cell near the points.
Work workOfScore(const GaussianEdt& edt) {
  return workOf({{Step::Trilinear, workOfTransform(edt)[static_cast<std::size_t>(Step::Exponential)]}});
}

/// The stages of whole clouds one after the other, as refineMaxima() calls them.
class DetectionStages {
public:
  DetectionStages(const Points& points, int num_repeats) : points_(points) {
    for (int i = 0; i < num_repeats; ++i) measureOnce();
    const double whole = leastMilliseconds(num_repeats, [&] { detectPlanes(points_, oneThread()); });
    Work all{};
    for (const Stage& stage : stages_)
      if (stage.name != kPaperGrid) all = all + stage.work;
    stages_.push_back({"whole detection", all, whole});
  }

  std::vector<Stage> stages() && { return std::move(stages_); }

private:
  static constexpr const char* kPaperGrid = "transform of 64 x 64 x 64 planes to 1 %";

  void record(const char* name, const Work& work, double milliseconds) {
    for (Stage& stage : stages_) {
      if (stage.name != name) continue;
      stage.milliseconds = std::min(stage.milliseconds, milliseconds);
      return;
    }
    stages_.push_back({name, work, milliseconds});
  }

  void measureOnce() {
    const DetectionOptions options = oneThread();
    ProcessorStopwatch watch;
    const GaussianEdt edt(points_, options.edt);
    record("distance transform", workOfTransform(edt), watch.lap());
    SampledTransformOptions sampling;
    sampling.num_samples = options.num_samples;
    sampling.num_threads = 1;
    const PlaneGrid fine(kCells, kCells, kCells, edt.center(), edt.radius());
    const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
    const double look_ups = first_ ? numLookUps(edt, fine, sampling.num_samples) : 0.0;
    const double grid_look_ups = first_ ? numLookUps(edt, grid, sampling.num_samples) : 0.0;
    first_ = false;
    watch.lap();
    sampledTransform(edt, fine, sampling);
    record(kPaperGrid, workOf({{Step::LookUp, look_ups}}), watch.lap());
    const SymmetryMap map = sampledTransform(edt, grid, sampling);
    record("transform of 32 x 128 x 64 planes", workOf({{Step::LookUp, grid_look_ups}}), watch.lap());
    refine(edt, map, options);
  }

  void refine(const GaussianEdt& edt, const SymmetryMap& map, const DetectionOptions& options) {
    const auto search = std::make_shared<CountingSearch>(normalizePoints(points_, edt.center(), edt.radius()));
    ProcessorStopwatch watch;
    const NormalizedCloud cloud(points_, edt, search, nullptr, 1);
    const auto fit =
        makePlaneFit(cloud, {options.update, options.num_refine_samples, options.max_iterations, options.seed, 1});
    const StagedRefinement refinement(cloud, *fit, options);
    const PlaneJudge judge(cloud, *fit, options);
    double elapsed = watch.lap();
    record("surface: normals, spacing", search->lap(), elapsed);
    watch.lap();
    std::vector<Candidate> candidates = gatherCandidates(cloud, map, options);
    record("maxima", workOf({{Step::ByteNear, 4.0 * static_cast<double>(map.values.size())}}), watch.lap());
    candidates = refinement.full(refinement.close(refinement.coarse(std::move(candidates), map.grid)));
    elapsed = watch.lap();
    record("refinement", search->lap(), elapsed);
    watch.lap();
    const std::vector<SymmetryPlane> planes = judge.preferringWhole(judge.judge(candidates));
    elapsed = watch.lap();
    Work work = search->lap();
    for (std::size_t i = 0; i < planes.size(); ++i) work = work + workOfScore(edt);
    record("decision", work, elapsed);
  }

  const Points& points_;
  std::vector<Stage> stages_;
  bool first_ = true;
};

void addScan(const Model& model, int num_repeats, std::vector<Stage>& stages) {
  const auto [scan, viewpoint] = model.scan(4 * kNumPoints);
  const std::optional<Visibility> seen = Visibility::fromPoints(scan, viewpoint);
  const GaussianEdt edt(scan, oneThread().edt);
  const auto detect = [&](bool turns) {
    DetectionOptions options = oneThread();
    options.turns = turns;
    std::shared_ptr<CountingSearch> search;
    const auto make = [&](const GaussianEdt& e) {
      return search = std::make_shared<CountingSearch>(normalizePoints(scan, e.center(), e.radius()));
    };
    const double time = leastMilliseconds(num_repeats, [&] { detectPlanes(scan, options, make, &*seen); });
    return std::pair(time, search->lap());
  };
  const auto [planes_ms, planes_work] = detect(false);
  const auto [all_ms, all_work] = detect(true);
  const DetectionOptions options;
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  // f and free space are read together.
  const Work map_work = workOfTransform(edt) + workOf({{Step::LookUp, numLookUps(edt, grid, options.num_samples)},
                                                       {Step::ByteNear, 8.0 * static_cast<double>(grid.size())}});
  stages.push_back({"scan: planes", planes_work + map_work, planes_ms});
  Work turns = all_work;
  for (std::size_t i = 0; i < turns.size(); ++i) turns[i] -= planes_work[i];
  stages.push_back({"scan: turns", turns, all_ms - planes_ms});
  stages.push_back({"scan: whole detection", all_work + map_work, all_ms});
}

void addRotations(const Points& points, int num_repeats, std::vector<Stage>& stages) {
  ObjectSymmetryOptions options;
  options.num_threads = 1;
  const GaussianEdt edt(points, oneThread().edt);
  // Turns of four prime orders about each direction are asked at 48 points first; one rotation is judged on all points.
  const double asked = 4.0 * 48.0 * options.num_directions;
  const Work work = workOfTransform(edt) + workOf({{Step::Trilinear, asked},
                                                   {Step::NineNearest, static_cast<double>(points.cols())},
                                                   {Step::Nearest, static_cast<double>(points.cols())}});
  stages.push_back({"rotations", work, leastMilliseconds(num_repeats, [&] { objectSymmetries(points, options); })});
}

void addDescription(const Model& model, int num_repeats, std::vector<Stage>& stages) {
  DescriptionOptions options;
  options.num_threads = 1;
  const Points points = model.sample(options.max_points);
  const Points frame_points = model.sample(options.max_frame_points);
  const GaussianEdt edt(frame_points, oneThread().edt);
  const FrameOptions frame;
  const PlaneGrid grid(frame.num_theta, frame.num_phi, frame.num_radius, edt.center(), edt.radius());
  // Each point counts in eight cells of two signatures, with six numbers.
  const double num_bytes = 2.0 * 8.0 * 6.0 * 4.0 * static_cast<double>(points.cols());
  const Work work = workOfTransform(edt) +
                    workOf({{Step::LookUp, numLookUps(edt, grid, frame.num_samples)}, {Step::ByteNear, num_bytes}});
  stages.push_back({"description", work, leastMilliseconds(num_repeats, [&] { describeShape(points, options); })});
}

/// A closed mesh of 17 280 faces with two bumps.
SurfaceGraph bumpyMesh() {
  constexpr int kRows = 96, kColumns = 180;
  Points vertices(3, (kRows + 1) * kColumns);
  std::vector<std::vector<int>> faces;
  for (int r = 0; r <= kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const double theta = 3.14159265358979323846 * r / kRows, phi = 2.0 * 3.14159265358979323846 * c / kColumns;
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double bumps = std::exp(12.0 * (n.x() - 1.0)) + 0.7 * std::exp(12.0 * (n.y() - 1.0));
      vertices.col(r * kColumns + c) = ((1.0 + bumps) * n).cast<float>();
      if (r == kRows) continue;
      const int a = r * kColumns + c, b = r * kColumns + (c + 1) % kColumns;
      faces.push_back({a, b, b + kColumns, a + kColumns});
    }
  }
  return meshGraph(vertices, faces);
}

void addSegmentation(int num_repeats, std::vector<Stage>& stages) {
  const SurfaceGraph graph = bumpyMesh();
  SegmentationOptions options;
  options.num_threads = 1;
  const GaussianEdt edt(graph.centers, oneThread().edt);
  const DetectionOptions detection;
  const PlaneGrid grid(detection.num_theta, detection.num_phi, detection.num_radius, edt.center(), edt.radius());
  // Planes of the whole, and one plane that maps each face to another.
  const Work work = workOfTransform(edt) + workOf({{Step::LookUp, numLookUps(edt, grid, detection.num_samples)},
                                                   {Step::Nearest, static_cast<double>(graph.size())}});
  stages.push_back({"segmentation of a mesh of 17 280 faces", work,
                    leastMilliseconds(num_repeats, [&] { segmentSurface(graph, options); })});
}

void addRegistration(const Model& model, int num_repeats, std::vector<Stage>& stages) {
  const auto unit = [&](Points points) {
    const BoundingBall ball = boundingBall(points);
    return normalizePoints(points, ball.center, ball.radius);
  };
  const Points points = unit(model.sample(kNumPoints));
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(1.0f, Eigen::Vector3f(1.0f, 2.0f, 3.0f).normalized()).matrix();
  const Points turned = turn * points;
  PoseSearchOptions options;
  options.num_threads = 1;
  const double time = leastMilliseconds(num_repeats, [&] {
    const PosedSurface scan(turned, std::nullopt, 1, 1), target(points, std::nullopt, 1, 1);
    searchPoses(scan, target, {}, options);
  });
  // Normals of both clouds; one pose that is judged on all points.
  const Work work = workOf({{Step::NineNearest, 2.0 * kNumPoints}, {Step::Nearest, 1.0 * kNumPoints}});
  stages.push_back({"registration", work, time});
}

void addRecognition(int num_repeats, std::vector<Stage>& stages) {
  constexpr int kNumModels = 815, kNumViews = 80, kNumFound = 50;
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
  const double time = leastMilliseconds(num_repeats, [&] { index.nearest(query, 0.25, kNumFound, 1); });
  const double num_bytes = static_cast<double>(kNumModels) * kNumViews * (kViewCodeSize + 2);
  stages.push_back({"recognition: views of 815 models", workOf({{Step::ByteNear, num_bytes}}), time});
}

}  // namespace

std::vector<Stage> measureStages(const Model& whole, int num_repeats) {
  const Points points = whole.sample(kNumPoints);
  std::vector<Stage> stages = DetectionStages(points, num_repeats).stages();
  const int fewer = std::max(2, num_repeats / 3);  // derived: these take longer, so that less disturbs them
  addScan(whole, fewer, stages);
  addRotations(points, fewer, stages);
  addDescription(whole, fewer, stages);
  addSegmentation(fewer, stages);
  addRegistration(whole, fewer, stages);
  addRecognition(num_repeats, stages);
  return stages;
}

}  // namespace pcl_symmetry::benchmarks
