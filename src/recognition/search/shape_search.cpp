#include "recognition/search/shape_search.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "core/matching/shape_description.h"
#include "recognition/packing/packed_model.h"
#include "recognition/storage/io_error.h"

namespace pcl_symmetry::detail {

namespace {

// Forms, at least, whose components are all compared. chosen: exact up to 1024 models; of more, half loses true
// neighbours of noisy queries, twice takes 5 ms more.
constexpr int kShapeCandidates = 2048;

Eigen::MatrixXf signaturesOf(ModelStore& store, const StoredModel& model, std::mutex& mutex) {
  const std::string bytes = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return store.part(ModelPart::Signatures, model);
  }();
  try {
    Eigen::MatrixXf signatures = unpackedSignatures(bytes);
    if (signatures.rows() == kSignatureSize && signatures.cols() == kFormsPerModel) return signatures;
    throw std::invalid_argument("have another size than those of this library");
  } catch (const std::invalid_argument& error) {
    failIO(store.file(), "the signatures of model '" + model.name + "' " + error.what());
  }
}

}  // namespace

bool isOutgrown(std::size_t num_references, std::size_t num_models, int max_references) {
  return num_references == 0 || 2 * num_references < std::min(num_models, static_cast<std::size_t>(max_references));
}

std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads) {
  const std::vector<StoredModel>& all = store.models();
  const std::size_t count = std::min(all.size(), static_cast<std::size_t>(max_references));
  std::vector<std::int64_t> ids;
  for (std::size_t r = 0; r < count; ++r) ids.push_back(all[r * all.size() / count].id);
  Eigen::MatrixXf signatures(kSignatureSize, kFormsPerModel * static_cast<Eigen::Index>(count));
  std::mutex mutex;
  parallelBlocks(count, num_threads, [&](std::size_t r) {
    signatures.middleCols<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(r)) =
        signaturesOf(store, all[r * all.size() / count], mutex);
  });
  return std::make_shared<const CompactForms>(CompactForms::fit(std::move(ids), signatures, num_threads));
}

std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms& forms, int num_threads) {
  std::vector<PackedForms> packed(models.size());
  std::mutex mutex;
  parallelBlocks(models.size(), num_threads, [&](std::size_t i) {
    packed[i] = {models[i].id, forms.formOf(signaturesOf(store, models[i], mutex), models[i].id).packed()};
  });
  return packed;
}

ShapeSearch::ShapeSearch(ModelStore& store, NumberedForms stored, const DatabaseOptions& options)
    : num_threads_(options.num_threads), forms_(std::move(stored.forms)), models_(store.models()) {
  if (models_.empty()) return;
  const auto num_references = static_cast<std::size_t>(forms_ ? forms_->numReferences() : 0);
  std::vector<StoredModel> without = models_;
  std::vector<PackedForms> packed;
  if (isOutgrown(num_references, models_.size(), options.num_references)) {
    forms_ = fitForms(store, options.num_references, num_threads_);
  } else {
    packed.reserve(models_.size());
    without = store.modelsWithoutForms();
    store.eachForms(stored.id, [&](PackedForms forms) { packed.push_back(std::move(forms)); });
  }
  for (PackedForms& made : formsOfModels(store, without, *forms_, num_threads_)) packed.push_back(std::move(made));

  std::sort(models_.begin(), models_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  std::sort(packed.begin(), packed.end(), [](const auto& a, const auto& b) { return a.model < b.model; });
  if (packed.size() != models_.size())
    failIO(store.file(), "has other compact forms than models, pcl_symmetry_database rebuild makes new ones");
  Eigen::MatrixXf compact(forms_->numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(packed.size()));
  std::vector<float> typical;
  for (std::size_t i = 0; i < packed.size(); ++i) {
    try {
      const CompactForm form = CompactForm::unpacked(packed[i].forms);
      if (packed[i].model != models_[i].id || form.compact.rows() != compact.rows())
        throw std::invalid_argument("is that of another model or projection");
      compact.middleCols<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(i)) = form.compact;
      typical.push_back(form.typical);
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the compact form of model '" + models_[i].name + "' " + error.what());
    }
    packed[i].forms = {};
  }
  CompactIndexOptions index;
  index.num_candidates = kShapeCandidates;
  index.num_threads = num_threads_;
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
    found.push_back({models_[static_cast<std::size_t>(model)], distance / root});
  return found;
}

}  // namespace pcl_symmetry::detail
