#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/matching/signature_projection.h"
#include "core/matching/view_code.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::detail {

/// Compact forms of each model: one for each of the two signatureFrames().
constexpr int kFormsPerModel = 2;

/// The form by which models are compared.
struct CompactForm {
  Eigen::MatrixXf compact;  ///< dimensions of the projection x kFormsPerModel
  float typical = 1.0f;     ///< mean distance to the nearest references, see typicalDistance()

  std::string packed() const;
  /// \throws std::invalid_argument for other bytes.
  static CompactForm unpacked(const std::string& bytes);
};

/// A projection and the models that it was fitted to, by which distances are also scaled.
class CompactForms {
public:
  /// \param ids ids of the references.
  /// \param signatures signatures of the references, kSignatureSize x (kFormsPerModel * number of references).
  /// \throws std::invalid_argument if all are alike.
  static CompactForms fit(std::vector<std::int64_t> ids, const Eigen::MatrixXf& signatures, int num_threads);

  const std::vector<std::int64_t>& references() const { return ids_; }  ///< ids, in order
  Eigen::Index numDimensions() const { return projection_.numDimensions(); }

  /// \param signatures kSignatureSize x kFormsPerModel.
  /// \param id id of the model, which is not compared with itself as a reference; 0 = of a query.
  CompactForm formOf(const Eigen::MatrixXf& signatures, std::int64_t id) const;
  /// All rotations of a form, see SignatureProjection::rotations().
  Eigen::MatrixXf rotations(const CompactForm& form) const { return projection_.rotations(form.compact); }

  std::string packed() const;
  /// \throws std::invalid_argument for other bytes.
  static CompactForms unpacked(const std::string& bytes);

private:
  SignatureProjection projection_;
  std::vector<std::int64_t> ids_;  // ids of the references
  Eigen::MatrixXf references_;     // compact forms of the references, side by side
};

/// Data fitted to the models of a database. Every function throws pcl::IOException, which names file and reason.
struct FittedForms {
  std::int64_t id = 0;  ///< number under which it is stored; 0 = not stored
  std::shared_ptr<const CompactForms> forms;
  std::shared_ptr<const ViewCoder> coder;

  /// \return whether it was fitted to these models, see referencesOf().
  bool isOf(const std::vector<StoredModel>& references) const;

  PackedProjection packed() const;
  /// \throws std::invalid_argument for other bytes.
  static FittedForms unpacked(const PackedProjection& packed);
};

/// The models that forms are fitted to, at most \p max_references, sorted by name: those whose names have the least
/// hashes. They depend only on the content of the database, and in a large one a new model is seldom among them.
std::vector<StoredModel> referencesOf(ModelStore& store, int max_references);

/// Fits forms to the referencesOf() a database.
/// \throws std::invalid_argument if all models are alike.
std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads);
std::shared_ptr<const ViewCoder> fitViewCoder(ModelStore& store, int max_references, int num_threads);

/// Makes forms of some models, on several threads: compact forms, codes of views, or both. A null argument leaves its
/// form out.
std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms* forms, const ViewCoder* coder, int num_threads);

/// The fitted data of each of some models, in their order: the stored bytes, or new ones if there are none.
/// \param models all models of the store.
/// \param stored the projection whose forms are read; 0 = all are made.
/// \param forms,coder one of them, whose compact forms or codes of views are requested; the other is null.
std::vector<std::string> allForms(ModelStore& store, const std::vector<StoredModel>& models, std::int64_t stored,
                                  const CompactForms* forms, const ViewCoder* coder, int num_threads);

/// Views of a model. \param mutex held while the store is read.
std::vector<View> viewsOf(ModelStore& store, const StoredModel& model, std::mutex& mutex);

}  // namespace pcl_symmetry::detail
