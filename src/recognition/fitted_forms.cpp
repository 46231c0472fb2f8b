#include "recognition/fitted_forms.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/matching/shape_signature.h"
#include "recognition/packed_bytes.h"
#include "recognition/packed_model.h"
#include "recognition/io_error.h"

namespace pcl_symmetry::detail {

namespace {

std::string partOf(ModelStore& store, ModelPart part, const StoredModel& model, std::mutex& mutex) {
  const std::lock_guard<std::mutex> lock(mutex);
  return store.part(part, model);
}

Eigen::MatrixXf signaturesOf(ModelStore& store, const StoredModel& model, std::mutex& mutex) {
  const std::string bytes = partOf(store, ModelPart::Signatures, model, mutex);
  try {
    Eigen::MatrixXf signatures = unpackedSignatures(bytes);
    if (signatures.rows() == kSignatureSize && signatures.cols() == kFormsPerModel) return signatures;
    throw std::invalid_argument("have another size than those of this library");
  } catch (const std::invalid_argument& error) {
    failIO(store.file(), "the signatures of model '" + model.name + "' " + error.what());
  }
}

/// Models spread evenly over all.
std::vector<StoredModel> referencesOf(ModelStore& store, int max_references) {
  const std::vector<StoredModel>& all = store.models();
  const std::size_t count = std::min(all.size(), static_cast<std::size_t>(max_references));
  std::vector<StoredModel> references;
  for (std::size_t r = 0; r < count; ++r) references.push_back(all[r * all.size() / count]);
  return references;
}

}  // namespace

PackedProjection FittedForms::packed() const {
  return {id, forms->numReferences(), forms->packed(), packedMatrix(coder->toValues(), MatrixBits::Sixteen)};
}

FittedForms FittedForms::unpacked(const PackedProjection& packed) {
  return {packed.id, std::make_shared<const CompactForms>(CompactForms::unpacked(packed.values)),
          std::make_shared<const ViewCoder>(ViewCoder::fromValues(unpackedMatrix(packed.view_coder)))};
}

bool isOutgrown(std::size_t num_references, std::size_t num_models, int max_references) {
  return num_references == 0 || 2 * num_references < std::min(num_models, static_cast<std::size_t>(max_references));
}

std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads) {
  const std::vector<StoredModel> references = referencesOf(store, max_references);
  std::vector<std::int64_t> ids;
  for (const StoredModel& model : references) ids.push_back(model.id);
  Eigen::MatrixXf signatures(kSignatureSize, kFormsPerModel * static_cast<Eigen::Index>(references.size()));
  std::mutex mutex;
  parallelBlocks(references.size(), num_threads, [&](std::size_t r) {
    signatures.middleCols<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(r)) =
        signaturesOf(store, references[r], mutex);
  });
  return std::make_shared<const CompactForms>(CompactForms::fit(std::move(ids), signatures, num_threads));
}

std::shared_ptr<const ViewCoder> fitViewCoder(ModelStore& store, int max_references, int num_threads) {
  const std::vector<StoredModel> references = referencesOf(store, max_references);
  std::vector<std::vector<View>> views(references.size());
  std::mutex mutex;
  parallelBlocks(references.size(), num_threads,
                 [&](std::size_t r) { views[r] = viewsOf(store, references[r], mutex); });
  std::vector<View> all;
  for (std::vector<View>& of_model : views)
    all.insert(all.end(), std::make_move_iterator(of_model.begin()), std::make_move_iterator(of_model.end()));
  // The same as those who read it.
  const std::string bytes = packedMatrix(ViewCoder::fit(all).toValues(), MatrixBits::Sixteen);
  return std::make_shared<const ViewCoder>(ViewCoder::fromValues(unpackedMatrix(bytes)));
}

std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms* forms, const ViewCoder* coder, int num_threads) {
  std::vector<PackedForms> packed(models.size());
  std::mutex mutex;
  parallelBlocks(models.size(), num_threads, [&](std::size_t i) {
    packed[i].model = models[i].id;
    if (forms) packed[i].forms = forms->formOf(signaturesOf(store, models[i], mutex), models[i].id).packed();
    if (coder) packed[i].view_codes = coder->codesOf(viewsOf(store, models[i], mutex));
  });
  return packed;
}

std::vector<View> viewsOf(ModelStore& store, const StoredModel& model, std::mutex& mutex) {
  const std::string bytes = partOf(store, ModelPart::Views, model, mutex);
  try {
    return unpackedViews(bytes);
  } catch (const std::invalid_argument& error) {
    failIO(store.file(), "the views of model '" + model.name + "' " + error.what());
  }
}

}  // namespace pcl_symmetry::detail
