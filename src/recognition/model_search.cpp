#include "recognition/model_search.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/matching/shape_signature.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

ShapeSearch::ShapeSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options)
    : num_threads_(options.num_threads), forms_(stored.forms), models_(store.models()) {
  if (models_.empty()) return;
  const bool is_fitted = stored.isOf(referencesOf(store, options.num_references));
  if (!is_fitted) forms_ = fitForms(store, options.num_references, num_threads_);
  makeIndex(store, is_fitted ? stored.id : 0, options);
}

/// \param stored the projection whose forms are read; 0 = all forms are made.
void ShapeSearch::makeIndex(ModelStore& store, std::int64_t stored, const DatabaseOptions& options) {
  Eigen::MatrixXf compact(forms_->numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(models_.size()));
  std::vector<float> typical;
  for (const std::string& bytes : allForms(store, models_, stored, forms_.get(), nullptr, num_threads_)) {
    const std::size_t i = typical.size();
    try {
      const CompactForm form = CompactForm::unpacked(bytes);
      if (form.compact.rows() != compact.rows()) throw std::invalid_argument("is that of another projection");
      compact.middleCols<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(i)) = form.compact;
      typical.push_back(form.typical);
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the compact form of model " + std::to_string(models_[i].id) + " " + error.what());
    }
  }
  CompactIndexOptions index;
  index.num_candidates = kRecognition.num_shape_forms;
  index.num_threads = options.num_threads;
  index_ = CompactIndex(std::move(compact), kFormsPerModel, index, std::move(typical));
}

std::vector<ShapeSearch::Found> ShapeSearch::nearest(const Points& points, const Visibility* seen,
                                                     int num_nearest) const {
  std::vector<Found> found;
  if (!forms_) return found;
  DescriptionOptions options;
  options.num_threads = num_threads_;
  const CompactForm form = forms_->formOf(describeShape(points, options, seen).signatures, 0);
  const double root = std::sqrt(form.typical);
  for (const auto& [model, distance] : index_.nearest(forms_->rotations(form), num_nearest))
    found.push_back({models_[model], distance / root});
  return found;
}

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

PairSearch::PairSearch(std::vector<StoredModel> models, const ShapeReader& read, const PairSearch* before,
                       int num_threads)
    : models_(std::move(models)), shapes_(models_.size()) {
  parallelBlocks(models_.size(), num_threads, [&](std::size_t i) {
    const std::size_t known = before ? before->indexOf(models_[i].id) : 0;
    shapes_[i] = before && known < before->shapes_.size() ? before->shapes_[known] : read(models_[i]);
  });
  std::vector<SurfacePoints> of_pairs;
  for (const auto& shape : shapes_) of_pairs.push_back(shape->of_pairs);
  index_.emplace(of_pairs, num_threads);
}

std::size_t PairSearch::indexOf(std::int64_t model) const {
  return static_cast<std::size_t>(
      std::find_if(models_.begin(), models_.end(), [&](const StoredModel& other) { return other.id == model; }) -
      models_.begin());
}

std::vector<PossibleModel> PairSearch::possibleModels(const SurfacePoints& scan, const std::vector<ModelOfView>& others,
                                                      int num_threads) const {
  std::vector<PossibleModel> models;
  for (std::size_t i = 0; i < models_.size(); ++i) models.push_back({models_[i], shapes_[i], {}});
  PairSearchOptions by_pairs;
  by_pairs.num_nearest = index_->numShapes();
  by_pairs.num_poses = kRecognition.num_pair_poses;
  by_pairs.num_threads = num_threads;
  for (ShapeOfPairs& shape : index_->nearest(scan, by_pairs))
    models[shape.shape].T_model_scan = std::move(shape.T_shape_scan);
  for (const ModelOfView& other : others) {
    const std::size_t i = indexOf(other.model.id);
    if (i == models.size()) continue;
    auto& poses = models[i].T_model_scan;
    poses.insert(poses.end(), other.T_model_scan.begin(), other.T_model_scan.end());
  }
  return models;
}

}  // namespace pcl_symmetry::detail
