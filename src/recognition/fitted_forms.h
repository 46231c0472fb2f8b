#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/matching/signature_projection.h"
#include "core/matching/view_code.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::detail {

/// Compact forms of each model: one for each of the signatureFrames().
constexpr int kFormsPerModel = 2;

/// What models are compared by.
struct CompactForm {
  Eigen::MatrixXf compact;  ///< dimensions of the projection x kFormsPerModel
  float typical = 1.0f;     ///< mean distance to the nearest references, see typicalDistance()

  std::string packed() const;
  /// \throws std::invalid_argument for other bytes.
  static CompactForm unpacked(const std::string& bytes);
};

/// A projection and the models that it was fitted to, by which distances are scaled as well.
class CompactForms {
public:
  /// \param ids of the references.
  /// \param signatures of the references, kSignatureSize x (kFormsPerModel * number of references).
  /// \throws std::invalid_argument where all are alike.
  static CompactForms fit(std::vector<std::int64_t> ids, const Eigen::MatrixXf& signatures, int num_threads);

  int numReferences() const { return static_cast<int>(ids_.size()); }
  Eigen::Index numDimensions() const { return projection_.numDimensions(); }

  /// \param signatures kSignatureSize x kFormsPerModel.
  /// \param id of the model, which is no reference of its own; 0: of a query.
  CompactForm formOf(const Eigen::MatrixXf& signatures, std::int64_t id) const;
  /// All rotations of a form, see SignatureProjection::rotations().
  Eigen::MatrixXf rotations(const CompactForm& form) const { return projection_.rotations(form.compact); }

  std::string packed() const;
  /// \throws std::invalid_argument for other bytes.
  static CompactForms unpacked(const std::string& bytes);

private:
  SignatureProjection projection_;
  std::vector<std::int64_t> ids_;  // of the references
  Eigen::MatrixXf references_;     // their compact forms side by side
};

/// What is fitted to the models of a database. Every function throws pcl::IOException, which names file and reason.
struct FittedForms {
  std::int64_t id = 0;  ///< the number that it is stored under, 0: it is not stored
  std::shared_ptr<const CompactForms> forms;
  std::shared_ptr<const ViewCoder> coder;

  PackedProjection packed() const;
  /// \throws std::invalid_argument for other bytes.
  static FittedForms unpacked(const PackedProjection& packed);
};

/// True where there are no references, or less than half of those that would be taken now.
bool isOutgrown(std::size_t num_references, std::size_t num_models, int max_references);

/// Fits to up to \p max_references models, spread evenly over all.
/// \throws std::invalid_argument where all models are alike.
std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads);
std::shared_ptr<const ViewCoder> fitViewCoder(ModelStore& store, int max_references, int num_threads);

/// Makes forms of some models, on several threads: compact forms, codes of views, or both; what is null is left out.
std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms* forms, const ViewCoder* coder, int num_threads);

/// What is fitted to each of some models, in their order: the bytes that are stored, or made where there are none.
/// \param models by rising id, all of the store.
/// \param stored the projection whose forms are read; 0: all are made.
/// \param forms,coder one of them, of which compact forms or codes of views are wanted; the other is null.
std::vector<std::string> allForms(ModelStore& store, const std::vector<StoredModel>& models, std::int64_t stored,
                                  const CompactForms* forms, const ViewCoder* coder, int num_threads);

/// Views of a model. \param mutex held while the store is read.
std::vector<View> viewsOf(ModelStore& store, const StoredModel& model, std::mutex& mutex);

}  // namespace pcl_symmetry::detail
