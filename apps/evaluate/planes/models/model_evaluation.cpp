#include "evaluate/planes/models/model_evaluation.h"

#include <pcl/conversions.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/base/constants.h"

namespace pcl_symmetry::apps {

namespace {

/// Degrees between the view direction and the normal of the best reference plane, as lines.
std::optional<double> viewAngle(const TestCloud& cloud, const ReferenceSymmetries& references) {
  if (!cloud.view || references.planes.empty()) return std::nullopt;
  const double cosine = std::abs(cloud.view->direction.dot(references.planes.front().plane.normal()));
  return std::acos(std::min(1.0, cosine)) * 180.0 / kPi;
}

}  // namespace

struct ModelEvaluation::Prepared {
  ReferenceSymmetries references;
  TestCloudMaker maker;
  TriangleScene scene;
  MeshReflection reflection;

  Prepared(const ReferenceSymmetries& found, const Model& model, const pcl::PolygonMesh& mesh,
           const EvaluatePlanesOptions& options)
      : references(found),
        maker(mesh, model.key, options.clouds),
        scene(mesh),
        reflection(scene, options.references.num_samples, options.references.seed) {}
};

/// \return what it gives; none where it throws, and the reason is kept.
template <typename Function>
auto ModelEvaluation::attempt(const std::string& what, const Function& function)
    -> std::optional<decltype(function())> {
  try {
    return function();
  } catch (const InputError& error) {
    result_.left_out.push_back(error.what());
  } catch (const std::exception& error) {
    result_.left_out.push_back(what + ": " + error.what());
  }
  return std::nullopt;
}

ModelResult ModelEvaluation::evaluate(const Model& model) {
  result_ = {};
  ground_truth_ = nlohmann::json::object();
  const auto attempted = attempt(model.path, [&] {
    const Shape shape = loadShape(model.path);
    if (!shape.mesh) throw InputError(model.path + ": has no faces");
    return std::make_unique<Prepared>(referencesOf(model, *shape.mesh), model, *shape.mesh, options_);
  });
  if (!attempted) return std::move(result_);
  const Prepared& prepared = **attempted;
  result_.kind = prepared.references.kind;
  if (options_.no_detect && !options_.export_folder) return std::move(result_);
  for (const CloudRecipe& recipe : recipes_) {
    const std::string name = model.name + "_" + recipe.name;
    if (const auto cloud = attempt(name, [&] { return prepared.maker.make(recipe); }))
      evaluate(name, model, recipe, *cloud, prepared);
  }
  if (options_.export_folder) result_.ground_truth = ground_truth_.dump();
  return std::move(result_);
}

ReferenceSymmetries ModelEvaluation::referencesOf(const Model& model, const pcl::PolygonMesh& mesh) {
  if (const auto known = known_.find(model.key, mesh.polygons.size())) return *known;
  result_.found_references = findReferenceSymmetries(mesh, options_.references);
  result_.num_faces = mesh.polygons.size();
  return *result_.found_references;
}

void ModelEvaluation::evaluate(const std::string& name, const Model& model, const CloudRecipe& recipe,
                               const TestCloud& cloud, const Prepared& prepared) {
  const ReferenceSymmetries references = prepared.references.transformed(cloud.T_cloud_model);
  ++result_.num_clouds;
  if (options_.export_folder) exportCloud(name, model, recipe, cloud, references);
  if (options_.no_detect) return;
  CloudResult result;
  result.model = model.name;
  result.cloud = name;
  result.recipe = recipe;
  for (const pcl::PointXYZ& point : *cloud.cloud) result.num_points += point.getVector3fMap().allFinite() ? 1 : 0;
  result.view_angle = viewAngle(cloud, references);
  result.kind = references.kind;
  result.best_share = references.best_share;
  result.num_reference_axes = static_cast<int>(references.axes.size());
  result.answers = answersFor(name, cloud);
  result.match = matchAnswers(result.answers.answers, references, options_.limits);
  result.operating_point = options_.operating_point;
  if (cloud.view) judgeByView(prepared, cloud, result);
  result_.clouds.push_back(std::move(result));
}

/// Whether the scan contradicts an answer is asked of those that are called symmetries and are wrong.
void ModelEvaluation::judgeByView(const Prepared& prepared, const TestCloud& cloud, CloudResult& result) const {
  result.view_verdicts.resize(result.answers.answers.size(), ViewVerdict::Undecidable);
  if (result.numFalse() == 0) return;
  const double tolerance = prepared.references.tolerance / prepared.references.diagonal;
  const VisibleSurface visible(prepared.scene, prepared.reflection, cloud, tolerance);
  for (std::size_t i = 0; i < result.view_verdicts.size(); ++i)
    if (result.match.judgements[i].verdict == Verdict::False)
      result.view_verdicts[i] = visible.verdictOf(result.answers.answers[i]);
}

PlaneAnswers ModelEvaluation::answersFor(const std::string& name, const TestCloud& cloud) {
  if (options_.planes_folder) return readAnswers(*options_.planes_folder, name);
  const auto detect = [&] {
    return detectAnswers(cloud.cloud, options_.common.seed + 1, options_.common.threads, options_.detect_tolerance);
  };
  if (!warm_) detect();  // threads, tables and pages are there from the second call on
  warm_ = true;
  return detect();
}

void ModelEvaluation::exportCloud(const std::string& name, const Model& model, const CloudRecipe& recipe,
                                  const TestCloud& cloud, const ReferenceSymmetries& references) {
  const auto path = boost::filesystem::path(*options_.export_folder) / (name + ".pcd");
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(*cloud.cloud, blob);
  saveCloud(path.string(), blob, cloud.cloud->sensor_origin_, cloud.cloud->sensor_orientation_);
  nlohmann::json truth = toJson(references);
  truth["file"] = name + ".pcd";
  truth["model"] = model.name;
  truth["group"] = recipe.group;
  ground_truth_[name] = std::move(truth);
}

}  // namespace pcl_symmetry::apps
