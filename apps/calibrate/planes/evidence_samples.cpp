#include "calibrate/planes/evidence_samples.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "core/detection/candidates.h"
#include "core/detection/plane_judge.h"
#include "core/detection/staged_refinement.h"
#include "core/distance_transform/free_space.h"
#include "core/neighbours/answerable_points.h"
#include "core/neighbours/diameter.h"
#include "core/neighbours/distinct_points.h"
#include "core/refinement/plane_tolerance.h"
#include "core/transform/sampled_transform.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/planes/plane_matching.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "pcl_symmetry/core/transform/planar_transform.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry::apps {

namespace {

constexpr int kTruthSamples = 4000;  // of the mesh. chosen: the standard error of a share of 0.97 is 0.003
// Every eighth of these tells which planes are far from a symmetry, below the second number. derived: the standard
// error of a share of 0.8 is then 0.018, five of which are less than the distance from 0.9.
constexpr int kScreenStride = 8;
constexpr double kSurelyNone = 0.8;
// Scans of each model with their viewpoint, and as many moved without it. chosen: two views say more than one; more
// views of one model say little new.
constexpr int kNumViews = 2;
constexpr int kRingPoints = 3500;  // of a scan in rings. chosen: near the mean of an object a few metres from a LiDAR
constexpr double kDepthNoise = 0.002;  // diagonals. chosen: a depth camera has 1 to 3 mm at one metre
// Points of shapes with folds, in turn, each for as many shapes as there are bodies, noises and thinnings. chosen: as
// of the clouds of models.
constexpr std::array<int, 3> kFoldedPoints{10'000, 3000, 30'000};
constexpr int kFoldedCases = 36;

CloudRecipe recipe(const std::string& name, int num_points, double noise, double missing, int view) {
  CloudRecipe result;
  result.group = result.name = name;
  result.num_points = num_points;
  result.noise = noise;
  result.missing = missing;
  result.view = view;
  return result;
}

/// As the detector sees them.
Points distinctPoints(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  return DistinctPoints(finitePoints(cloud)).points;
}

/// Candidates of the whole, after all stages of refinement, as detectPlanes() judges them, best merit first and merged
/// as answers are. No fitted number has a part in it: a fit can be repeated.
std::vector<JudgedPlane> judgedCandidates(const Points& points, const Visibility* visibility,
                                          const DetectionOptions& options) {
  const GaussianEdt edt(points, options.edt);
  std::vector<float> free_space;
  if (visibility) free_space = freeSpace(edt, *visibility, options.num_threads);
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.num_threads = options.num_threads;
  SymmetryMap map = sampledTransform(edt, grid, sampling, free_space);
  map.center_of_mass = centerOfMass(points);
  const NormalizedCloud cloud(points, edt, nullptr, visibility, options.num_threads);
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(
      cloud, {options.update, options.num_refine_samples, options.max_iterations, options.seed, options.num_threads});
  const StagedRefinement refinement(cloud, *fit, options);
  std::vector<Candidate> candidates =
      refinement.full(refinement.close(refinement.coarse(gatherCandidates(cloud, map, options), grid)));
  refinement.climb(candidates);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
  const PlaneTolerance same{options.merge_angle, options.merge_offset};
  std::vector<Candidate> distinct;
  for (Candidate& candidate : candidates)
    if (!same.anySame(distinct, candidate.plane, [](const Candidate& other) { return other.plane; }))
      distinct.push_back(std::move(candidate));
  return PlaneJudge(cloud, *fit, options).judgeWithEvidence(distinct);
}

DetectionOptions optionsOf(double tolerance) {
  DetectionOptions options;
  options.num_threads = options.edt.num_threads = 1;
  options.tolerance = tolerance;
  return options;
}

/// A plane of a cloud in the frame of the model's scene.
ReflectionPlane toScene(const ReflectionPlane& plane, const Eigen::Isometry3d& T_cloud_model,
                        const TriangleScene& scene) {
  const Eigen::Isometry3d T_model_cloud = T_cloud_model.inverse();
  const Eigen::Vector3d normal = T_model_cloud.linear() * plane.normal();
  const Eigen::Vector3d point = T_model_cloud * (plane.offset() * plane.normal());
  return ReflectionPlane(normal, normal.dot(point - scene.center()) / scene.diagonal());
}

/// The planes of one model in the frame of its scene, and what they map.
class PlaneTruths {
public:
  PlaneTruths(const TriangleScene& scene, double tolerance)
      : scene_(scene), truth_(scene, kTruthSamples, 1), tolerance_(tolerance * diameter(truth_.samples())) {}

  /// \param row of the cloud that the planes are of.
  void add(const std::vector<JudgedPlane>& planes, const std::string& model, const std::string& row,
           const Eigen::Isometry3d& T_cloud_model) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const ReflectionPlane plane = toScene(planes[i].plane, T_cloud_model, scene_);
      double share = truth_.share(plane, tolerance_, kScreenStride);
      if (share >= kSurelyNone) share = truth_.share(plane, tolerance_);
      samples_.push_back({model, row, planes[i].evidence, share, share, static_cast<int>(i)});
      planes_.push_back(plane);
    }
  }

  /// All samples, with the best plane that any cloud of the model has within the limits of a right answer.
  std::vector<EvidenceSample> samples() const {
    const MatchLimits limits;
    std::vector<EvidenceSample> samples = samples_;
    for (std::size_t j = 0; j < samples.size(); ++j) {
      if (samples_[j].share < kSurelyNone) continue;
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples_[j].share > samples[i].near_share && difference(planes_[i], planes_[j], Eigen::Vector3d::Zero())
                                                             .within(limits.max_angle * kDegree, limits.max_offset))
          samples[i].near_share = samples_[j].share;
    }
    return samples;
  }

private:
  const TriangleScene& scene_;
  MeshReflection truth_;
  double tolerance_;  ///< diagonals
  std::vector<EvidenceSample> samples_;
  std::vector<ReflectionPlane> planes_;  ///< one for each sample
};

/// Candidates of a cloud, of which the data say what the scanner saw, as for a user.
std::vector<JudgedPlane> judgedCandidates(const TestCloud& cloud, const DetectionOptions& options) {
  const Points points = distinctPoints(*cloud.cloud);
  if (!whyUnanswerable(points).empty()) return {};
  const std::optional<Visibility> seen = detail::seenSpace(*cloud.cloud, points, Viewpoint());
  return judgedCandidates(points, seen ? &*seen : nullptr, options);
}

}  // namespace

std::vector<CloudRecipe> calibrationRecipes() {
  std::vector<CloudRecipe> recipes{
      recipe("whole", 10'000, 0.0, 0.0, -1),       recipe("1000 points", 1000, 0.0, 0.0, -1),
      recipe("3000 points", 3000, 0.0, 0.0, -1),   recipe("40 000 points", 40'000, 0.0, 0.0, -1),
      recipe("noise 0.005", 10'000, 0.005, 0, -1), recipe("noise 0.01", 10'000, 0.01, 0.0, -1),
      recipe("noise 0.02", 10'000, 0.02, 0.0, -1), recipe("cut off 0.05", 10'000, 0.0, 0.05, -1),
      recipe("cut off 0.2", 10'000, 0.0, 0.2, -1), recipe("cut off 0.5", 10'000, 0.0, 0.5, -1)};
  for (const bool moved : {false, true}) {
    for (int view = 0; view < kNumViews; ++view) {
      recipes.push_back(recipe((moved ? "moved " : "scan ") + std::to_string(view + 1), 10'000, 0.0, 0.0, view));
      recipes.back().moved = moved;
    }
  }
  for (const int num_points : {1000, 2500})
    recipes.push_back(recipe("scan of " + std::to_string(num_points), num_points, 0.0, 0.0, 0));
  for (const int distance : {4, 8}) {
    recipes.push_back(recipe("scan in rings " + std::to_string(distance), distance * kRingPoints, 0.0, 0.0, 1));
    recipes.back().ring_distance = distance;
  }
  recipes.push_back(recipe("scan with noise", 10'000, kDepthNoise, 0.0, 1));
  return recipes;
}

std::vector<EvidenceSample> sampleFoldedEvidence(int i, double tolerance) {
  ShapeRowOptions seeds;
  const FoldedCloud folded = foldedCloud(i, seeds.caseSeed(i), seeds.report, kFoldedPoints[i / kFoldedCases % 3]);
  const TriangleScene scene(folded.shape.mesh);
  PlaneTruths truths(scene, tolerance);
  truths.add(judgedCandidates(distinctPoints(*folded.cloud), nullptr, optionsOf(tolerance)),
             folded.body + " " + std::to_string(i), "folds noise " + std::to_string(folded.noise), folded.pose);
  return truths.samples();
}

std::vector<EvidenceSample> sampleEvidence(const Model& model, double tolerance) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) throw InputError(model.path + ": has no faces");
  const TriangleScene scene(*shape.mesh);
  TestCloudOptions cloud_options;
  cloud_options.random_views = true;
  const TestCloudMaker maker(*shape.mesh, model.key, cloud_options);
  PlaneTruths truths(scene, tolerance);
  for (const CloudRecipe& recipe : calibrationRecipes()) {
    const TestCloud cloud = maker.make(recipe);
    truths.add(judgedCandidates(cloud, optionsOf(tolerance)), model.name, recipe.name, cloud.T_cloud_model);
  }
  return truths.samples();
}

}  // namespace pcl_symmetry::apps
