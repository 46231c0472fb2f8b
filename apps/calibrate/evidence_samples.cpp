#include "calibrate/evidence_samples.h"

#include <array>
#include <memory>

#include "common/shape_input/shape_input.h"
#include "core/detection/candidates.h"
#include "core/detection/plane_judge.h"
#include "core/detection/staged_refinement.h"
#include "core/distance_transform/free_space.h"
#include "core/neighbours/answerable_points.h"
#include "core/neighbours/diameter.h"
#include "core/neighbours/distinct_points.h"
#include "core/transform/sampled_transform.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kTruthSamples = 4000;  // of the mesh. chosen: the standard error of a share of 0.97 is 0.003
// Scans of each model. chosen: two views say more than one; more views of one model say little new.
constexpr int kNumViews = 2;
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

Points finitePoints(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  Points points(3, static_cast<Eigen::Index>(cloud.size()));
  Eigen::Index size = 0;
  for (const pcl::PointXYZ& point : cloud)
    if (point.getVector3fMap().allFinite()) points.col(size++) = point.getVector3fMap();
  points.conservativeResize(3, size);
  return DistinctPoints(points).points;
}

/// Candidates of the whole, after all stages of refinement, as detectPlanes() judges them.
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
  const PlaneJudge judge(cloud, *fit, options);
  return judge.judgeWithEvidence(
      refinement.full(refinement.close(refinement.coarse(gatherCandidates(cloud, map, options), grid))));
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

}  // namespace

std::vector<CloudRecipe> calibrationRecipes() {
  std::vector<CloudRecipe> recipes{
      recipe("whole", 10'000, 0.0, 0.0, -1),       recipe("1000 points", 1000, 0.0, 0.0, -1),
      recipe("3000 points", 3000, 0.0, 0.0, -1),   recipe("40 000 points", 40'000, 0.0, 0.0, -1),
      recipe("noise 0.005", 10'000, 0.005, 0, -1), recipe("noise 0.01", 10'000, 0.01, 0.0, -1),
      recipe("noise 0.02", 10'000, 0.02, 0.0, -1), recipe("cut off 0.05", 10'000, 0.0, 0.05, -1),
      recipe("cut off 0.2", 10'000, 0.0, 0.2, -1), recipe("cut off 0.5", 10'000, 0.0, 0.5, -1)};
  for (int view = 0; view < kNumViews; ++view)
    recipes.push_back(recipe("scan " + std::to_string(view + 1), 10'000, 0.0, 0.0, view));
  return recipes;
}

std::vector<EvidenceSample> sampleFoldedEvidence(int i, double tolerance) {
  ShapeRowOptions seeds;
  const FoldedCloud folded = foldedCloud(i, seeds.caseSeed(i), seeds.report, kFoldedPoints[i / kFoldedCases % 3]);
  const TriangleScene scene(folded.shape.mesh);
  const MeshReflection truth(scene, kTruthSamples, 1);
  const double mesh_tolerance = tolerance * diameter(truth.samples());
  std::vector<EvidenceSample> samples;
  const std::string row = "folds, noise " + std::to_string(folded.noise);
  for (const JudgedPlane& judged : judgedCandidates(finitePoints(*folded.cloud), nullptr, optionsOf(tolerance)))
    samples.push_back({folded.body + " " + std::to_string(i), row, judged.evidence,
                       truth.share(toScene(judged.plane, folded.pose, scene), mesh_tolerance)});
  return samples;
}

std::vector<EvidenceSample> sampleEvidence(const Model& model, double tolerance) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) throw InputError(model.path + ": has no faces");
  const TriangleScene scene(*shape.mesh);
  const MeshReflection truth(scene, kTruthSamples, 1);
  const double mesh_tolerance = tolerance * diameter(truth.samples());
  TestCloudOptions cloud_options;
  cloud_options.random_views = true;
  const TestCloudMaker maker(*shape.mesh, model.key, cloud_options);
  const DetectionOptions options = optionsOf(tolerance);
  std::vector<EvidenceSample> samples;
  for (const CloudRecipe& recipe : calibrationRecipes()) {
    const TestCloud cloud = maker.make(recipe);
    const Points points = finitePoints(*cloud.cloud);
    if (!whyUnanswerable(points).empty()) continue;
    std::optional<Visibility> seen;
    if (recipe.view >= 0) seen = spaceSeenFrom(points, cloud.cloud->sensor_origin_.head<3>().cast<double>());
    for (const JudgedPlane& judged : judgedCandidates(points, seen ? &*seen : nullptr, options))
      samples.push_back({model.name, recipe.name, judged.evidence,
                         truth.share(toScene(judged.plane, cloud.T_cloud_model, scene), mesh_tolerance)});
  }
  return samples;
}

}  // namespace pcl_symmetry::apps
