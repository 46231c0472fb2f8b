#include "recognition/fitted_forms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/matching/compact_index.h"
#include "core/matching/shape_signature.h"
#include "recognition/packed_model.h"

namespace pcl_symmetry::detail {

namespace {

/// Rows of a projection's numbers that belong together: mean and basis, then rotations.
Eigen::Map<const Eigen::MatrixXf> columnsOf(const std::vector<float>& values, std::size_t first, Eigen::Index rows) {
  return {values.data() + first, rows, static_cast<Eigen::Index>(values.size() - first) / rows};
}

void append(const Eigen::MatrixXf& matrix, std::vector<float>& values) {
  values.insert(values.end(), matrix.data(), matrix.data() + matrix.size());
}

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

/// FNV-1a.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace

std::vector<StoredModel> referencesOf(ModelStore& store, int max_references) {
  std::vector<StoredModel> references = store.models();
  const auto count = static_cast<std::size_t>(max_references);
  if (count >= references.size()) return references;
  const auto byHash = [](const StoredModel& a, const StoredModel& b) {
    return std::make_pair(hashOf(a.name), a.name) < std::make_pair(hashOf(b.name), b.name);
  };
  std::nth_element(references.begin(), references.begin() + max_references, references.end(), byHash);
  references.resize(count);
  std::sort(references.begin(), references.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return references;
}

std::string CompactForm::packed() const {
  PackedBytes bytes;
  bytes.put(typical);
  bytes.append(packedMatrix(compact, MatrixBits::Sixteen));
  return bytes.bytes();
}

CompactForm CompactForm::unpacked(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  CompactForm form;
  form.typical = packed.get<float>();
  form.compact = unpackedMatrix(bytes.substr(sizeof(float)));
  check(form.compact.cols() == kFormsPerModel && form.typical > 0.0f, "compact form", form.compact.cols(),
        "kFormsPerModel columns");
  return form;
}

CompactForms CompactForms::fit(std::vector<std::int64_t> ids, const Eigen::MatrixXf& signatures, int num_threads) {
  const auto count = static_cast<Eigen::Index>(ids.size());
  Eigen::MatrixXf first(signatures.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) first.col(i) = signatures.col(kFormsPerModel * i);
  ProjectionOptions options;
  options.num_threads = num_threads;
  CompactForms forms;
  forms.projection_ = SignatureProjection::fit(first, options);
  forms.ids_ = std::move(ids);
  forms.references_ = forms.projection_.project(signatures);
  return unpacked(forms.packed());  // the same as those who read it
}

CompactForm CompactForms::formOf(const Eigen::MatrixXf& signatures, std::int64_t id) const {
  CompactForm form;
  form.compact = projection_.project(signatures);
  const Eigen::RowVectorXf cosines = (rotations(form).transpose() * references_).colwise().maxCoeff();
  std::vector<float> distances;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const float cosine = cosines.segment<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(i)).maxCoeff();
    distances.push_back(ids_[i] == id ? std::numeric_limits<float>::infinity()
                                      : std::sqrt(std::max(0.0f, 2.0f - 2.0f * cosine)));
  }
  form.typical = typicalDistance(std::move(distances));
  return form;
}

std::string CompactForms::packed() const {
  const std::vector<float> values = projection_.toValues();
  const Eigen::Index k = numDimensions();
  const std::size_t num_basis = static_cast<std::size_t>(kSignatureSize * (1 + k));
  PackedBytes bytes;
  bytes.put(static_cast<std::uint32_t>(ids_.size()));
  for (const std::int64_t id : ids_) bytes.put(id);
  const std::vector<float> basis(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(num_basis));
  bytes.putText(packedMatrix(columnsOf(basis, 0, kSignatureSize), MatrixBits::Sixteen));
  bytes.putText(packedMatrix(columnsOf(values, num_basis, k), MatrixBits::Sixteen));
  bytes.putText(packedMatrix(references_, MatrixBits::Sixteen));
  return bytes.bytes();
}

CompactForms CompactForms::unpacked(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  CompactForms forms;
  const std::size_t count = packed.get<std::uint32_t>();
  if (count > packed.left() / sizeof(std::int64_t)) throw std::invalid_argument("is incomplete");
  for (std::size_t i = 0; i < count; ++i) forms.ids_.push_back(packed.get<std::int64_t>());
  std::vector<float> values;
  for (int i = 0; i < 2; ++i) append(unpackedMatrix(packed.text()), values);
  forms.projection_ = SignatureProjection::fromValues(values);
  forms.references_ = unpackedMatrix(packed.text());
  check(forms.references_.rows() == forms.numDimensions() &&
            forms.references_.cols() == kFormsPerModel * static_cast<Eigen::Index>(count),
        "number of references", forms.references_.cols(), "that of their compact forms");
  return forms;
}

PackedProjection FittedForms::packed() const {
  return {id, static_cast<int>(forms->references().size()), forms->packed(),
          packedMatrix(coder->toValues(), MatrixBits::Sixteen)};
}

FittedForms FittedForms::unpacked(const PackedProjection& packed) {
  return {packed.id, std::make_shared<const CompactForms>(CompactForms::unpacked(packed.values)),
          std::make_shared<const ViewCoder>(ViewCoder::fromValues(unpackedMatrix(packed.view_coder)))};
}

bool FittedForms::isOf(const std::vector<StoredModel>& references) const {
  return forms &&
         std::equal(references.begin(), references.end(), forms->references().begin(), forms->references().end(),
                    [](const StoredModel& model, std::int64_t reference) { return model.id == reference; });
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

std::vector<std::string> allForms(ModelStore& store, const std::vector<StoredModel>& models, std::int64_t stored,
                                  const CompactForms* forms, const ViewCoder* coder, int num_threads) {
  const FormPart part = forms ? FormPart::Compact : FormPart::ViewCodes;
  std::vector<std::string> all(models.size());
  const auto fail = [&](std::int64_t id, const std::string& reason) {
    failIO(store.file(), nameOf(part) + std::to_string(id) + reason + ", pcl_symmetry_database rebuild makes new ones");
  };
  std::unordered_map<std::int64_t, std::size_t> index;
  for (std::size_t i = 0; i < models.size(); ++i) index[models[i].id] = i;
  const auto take = [&](std::int64_t id, const std::string& bytes) {
    const auto model = index.find(id);
    if (model == index.end()) fail(id, " is that of another model");
    all[model->second] = bytes;
  };
  if (stored != 0) store.each(part, stored, take);
  const std::vector<StoredModel> without = stored != 0 ? store.modelsWithoutForms() : models;
  for (const PackedForms& made : formsOfModels(store, without, forms, coder, num_threads))
    take(made.model, forms ? made.forms : made.view_codes);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].empty()) fail(models[i].id, " is missing");
  return all;
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
