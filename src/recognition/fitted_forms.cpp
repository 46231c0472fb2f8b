#include "recognition/fitted_forms.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

Eigen::MatrixXf signaturesOf(ModelStore& store, const StoredModel& model, std::mutex& mutex) {
  return unpackedPart(store, ModelPart::Signatures, "signatures", model, mutex, [](const std::string& bytes) {
    Eigen::MatrixXf signatures = unpackedSignatures(bytes);
    if (signatures.rows() == kSignatureSize && signatures.cols() == kFormsPerModel) return signatures;
    throw std::invalid_argument("have another size than those of this library");
  });
}

/// FNV-1a hash.
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
  return packedMatrices({compact, Eigen::MatrixXf::Constant(1, 1, typical)});
}

CompactForm CompactForm::unpacked(const std::string& bytes) {
  const std::vector<Eigen::MatrixXf> matrices = unpackedMatrices(bytes);
  check(
      matrices.size() == 2 && matrices[0].cols() == kFormsPerModel && matrices[1].size() == 1 && matrices[1](0) > 0.0f,
      "compact form", matrices.size(), "that of a model");
  return {matrices[0], matrices[1](0)};
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
  return forms;
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
  const auto size = static_cast<std::uint32_t>(ids_.size());
  return std::string(reinterpret_cast<const char*>(&size), sizeof(size)) +
         std::string(reinterpret_cast<const char*>(ids_.data()), ids_.size() * sizeof(ids_[0])) +
         packedMatrices(
             {Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size())), references_});
}

CompactForms CompactForms::unpacked(const std::string& bytes) {
  CompactForms forms;
  std::uint32_t size = 0;
  if (bytes.size() < sizeof(size)) throw std::invalid_argument("is incomplete");
  std::memcpy(&size, bytes.data(), sizeof(size));
  if (size > (bytes.size() - sizeof(size)) / sizeof(forms.ids_[0])) throw std::invalid_argument("is incomplete");
  forms.ids_.resize(size);
  const std::size_t size_of_ids = size * sizeof(forms.ids_[0]);
  if (size > 0) std::memcpy(forms.ids_.data(), bytes.data() + sizeof(size), size_of_ids);
  std::vector<Eigen::MatrixXf> matrices = unpackedMatrices(bytes.substr(sizeof(size) + size_of_ids));
  if (matrices.size() != 2) throw std::invalid_argument("is incomplete");
  forms.projection_ = SignatureProjection::fromValues({matrices[0].data(), matrices[0].data() + matrices[0].size()});
  forms.references_ = std::move(matrices[1]);
  check(forms.references_.rows() == forms.numDimensions() &&
            forms.references_.cols() == kFormsPerModel * static_cast<Eigen::Index>(size),
        "number of references", forms.references_.cols(), "that of their compact forms");
  return forms;
}

PackedProjection FittedForms::packed() const {
  return {id, static_cast<int>(forms->references().size()), forms->packed(), packedMatrices({coder->toValues()})};
}

FittedForms FittedForms::unpacked(const PackedProjection& packed) {
  const std::vector<Eigen::MatrixXf> coder = unpackedMatrices(packed.view_coder);
  if (coder.size() != 1) throw std::invalid_argument("is incomplete");
  return {packed.id, std::make_shared<const CompactForms>(CompactForms::unpacked(packed.values)),
          std::make_shared<const ViewCoder>(ViewCoder::fromValues(coder[0]))};
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
  return std::make_shared<const ViewCoder>(ViewCoder::fit(all));
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
  return unpackedPart(store, ModelPart::Views, "views", model, mutex, unpackedViews);
}

}  // namespace pcl_symmetry::detail
