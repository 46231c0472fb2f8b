#include "recognition/model_search.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/matching/shape_description.h"

namespace pcl_symmetry::detail {

void ModelSearch::restore(SignatureProjection projection, int num_references) {
  projection_ = std::move(projection);
  num_references_ = num_references;
}

void ModelSearch::fit(Models& models, const ModelFolder& folder) {
  std::vector<Model*> all;
  for (auto& [name, model] : models) {
    model.compact.resize(0, 0);
    all.push_back(&model);
  }
  const std::size_t count = std::min(all.size(), static_cast<std::size_t>(max_references_));
  projection_ = {};
  num_references_ = static_cast<int>(count);
  if (count == 0) return;
  Eigen::MatrixXf references(kSignatureSize, static_cast<Eigen::Index>(count));
  parallelBlocks(count, num_threads_, [&](std::size_t r) {
    references.col(static_cast<Eigen::Index>(r)) = folder.signatures(*all[r * all.size() / count]).col(0);
  });
  ProjectionOptions options;
  options.num_threads = num_threads_;
  projection_ = SignatureProjection::fit(references, options);
}

bool ModelSearch::isOutgrown(const Models& models) const {
  const std::size_t wanted = std::min(models.size(), static_cast<std::size_t>(max_references_));
  return projection_.empty() || 2 * static_cast<std::size_t>(num_references_) < wanted;
}

void ModelSearch::index(Models& models, const ModelFolder& folder) {
  names_.clear();
  std::vector<Model*> all;
  for (auto& [name, model] : models) {
    names_.push_back(name);
    all.push_back(&model);
  }
  parallelBlocks(all.size(), num_threads_, [&](std::size_t i) {
    if (all[i]->compact.size() == 0) all[i]->compact = projection_.project(folder.signatures(*all[i]));
  });
  Eigen::MatrixXf forms(projection_.numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(all.size()));
  views_ = {};
  for (std::size_t i = 0; i < all.size(); ++i) {
    forms.middleCols(kFormsPerModel * static_cast<Eigen::Index>(i), kFormsPerModel) = all[i]->compact;
    views_.add(folder.views(*all[i]));
  }
  CompactIndexOptions options;
  options.num_threads = num_threads_;
  shapes_ = CompactIndex(std::move(forms), kFormsPerModel, options);
}

void ModelSearch::forget(const std::string& name) {
  std::replace(names_.begin(), names_.end(), name, std::string());
}

std::vector<ModelMatch> ModelSearch::likeShapes(const Points& points, const Visibility* seen, int num_nearest) const {
  std::vector<ModelMatch> matches;
  if (projection_.empty()) return matches;
  DescriptionOptions options;
  options.num_threads = num_threads_;
  const Eigen::MatrixXf forms = projection_.project(describeShape(points, options, seen).signatures);
  for (const auto& [model, distance] : shapes_.nearest(projection_.rotations(forms), num_nearest)) {
    const std::string& name = names_[static_cast<std::size_t>(model)];
    if (!name.empty()) matches.push_back({name, distance});
  }
  return matches;
}

std::vector<ModelOfView> ModelSearch::likeViews(const View& scan, const ViewSearchOptions& options) const {
  std::vector<ModelOfView> models;
  for (ShapeOfView& shape : views_.nearest(scan, options)) {
    const std::string& name = names_[static_cast<std::size_t>(shape.shape)];
    if (!name.empty()) models.push_back({name, std::move(shape.T_shape_scan)});
  }
  return models;
}

}  // namespace pcl_symmetry::detail
