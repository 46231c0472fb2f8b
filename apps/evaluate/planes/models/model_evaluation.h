/// Makes the clouds of a model and looks for their planes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/planes/models/model_result.h"
#include "evaluate/planes/models/plane_options.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

/// One model at a time.
class ModelEvaluation {
public:
  /// \param known references that need not be searched; both have to outlive this object.
  ModelEvaluation(const EvaluatePlanesOptions& options, const std::vector<CloudRecipe>& recipes,
                  const ReferenceCache& known)
      : options_(options), recipes_(recipes), known_(known) {}

  ModelResult evaluate(const Model& model);

private:
  struct Prepared;
  template <typename Function>
  auto attempt(const std::string& what, const Function& function) -> std::optional<decltype(function())>;
  ReferenceSymmetries referencesOf(const Model& model, const pcl::PolygonMesh& mesh);
  void evaluate(const std::string& name, const Model& model, const CloudRecipe& recipe, const TestCloud& cloud,
                const Prepared& prepared);
  void judgeByView(const Prepared& prepared, const TestCloud& cloud, CloudResult& result) const;
  PlaneAnswers answersFor(const std::string& name, const TestCloud& cloud);
  void exportCloud(const std::string& name, const Model& model, const CloudRecipe& recipe, const TestCloud& cloud,
                   const ReferenceSymmetries& references);

  const EvaluatePlanesOptions& options_;
  const std::vector<CloudRecipe>& recipes_;
  const ReferenceCache& known_;
  bool warm_ = false;
  ModelResult result_;
  nlohmann::json ground_truth_;
};

}  // namespace pcl_symmetry::apps
