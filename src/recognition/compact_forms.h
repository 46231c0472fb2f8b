#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/matching/signature_projection.h"

namespace pcl_symmetry::detail {

/// Compact forms of each model: one for each of the signatureFrames().
constexpr int kFormsPerModel = 2;  // derived: the number of signatureFrames()

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

}  // namespace pcl_symmetry::detail
