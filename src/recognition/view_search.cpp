#include "recognition/view_search.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

namespace {

ViewIndex indexOf(const std::vector<StoredModel>& models, const ViewSearch::ViewReader& read, int num_threads) {
  std::vector<std::vector<View>> views(models.size());
  parallelBlocks(models.size(), num_threads, [&](std::size_t i) { views[i] = read(models[i]); });
  ViewIndex index;
  for (std::vector<View>& of_model : views) index.add(std::exchange(of_model, {}));
  return index;
}

}  // namespace

ViewSearch::ViewSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options)
    : models_(store.models()) {
  if (models_.size() <= kRecognition.num_view_models) {
    std::mutex mutex;
    all_ = indexOf(
        models_, [&](const StoredModel& model) { return viewsOf(store, model, mutex); }, options.num_threads);
    return;
  }
  const bool is_fitted = stored.isOf(referencesOf(store, options.num_references));
  coder_ = is_fitted ? stored.coder : fitViewCoder(store, options.num_references, options.num_threads);
  for (const std::string& bytes :
       allForms(store, models_, is_fitted ? stored.id : 0, nullptr, coder_.get(), options.num_threads)) {
    try {
      codes_.add(bytes);
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the code of views of model " + std::to_string(models_[codes_.numShapes()].id) +
                               " is damaged: " + error.what() + ", pcl_symmetry_database rebuild makes new ones");
    }
  }
}

std::vector<ModelOfView> ViewSearch::nearest(const View& scan, int num_nearest, int num_threads,
                                             const ViewReader& read) const {
  std::vector<StoredModel> candidates;
  ViewIndex index;
  if (coder_) {
    const auto count = std::max(kRecognition.num_view_models, static_cast<std::size_t>(num_nearest));
    for (const int model : codes_.nearest(coder_->codeOf(scan), static_cast<int>(count), num_threads))
      candidates.push_back(models_[model]);
    index = indexOf(candidates, read, num_threads);
  }
  std::vector<ModelOfView> found;
  for (ShapeOfView& shape : (coder_ ? index : all_).nearest(scan, num_nearest, num_threads))
    found.push_back({(coder_ ? candidates : models_)[shape.shape], std::move(shape.T_shape_scan)});
  return found;
}

}  // namespace pcl_symmetry::detail
