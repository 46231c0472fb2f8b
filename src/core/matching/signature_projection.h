#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/matching/shape_signature.h"

namespace pcl_symmetry {

struct ProjectionOptions {
  int num_dimensions = 256;  ///< dimensions of the compact form, >= 1; fewer if the references span fewer
  int num_threads = 0;       ///< >= 0; 0 = one per core
};

/// Rotates a signature or another descriptor by one of the axisRotations().
using SignatureRotation = void (*)(const float* values, int rotation, float* rotated);

/// Compact forms of signatures (Section 5.2): their principal components. A shape is projected once for all 24
/// rotations of its axes. Not in the paper.
///
/// The components are those of the reference shapes in all 24 rotations, about zero: about the mean of a few shapes,
/// all shapes unlike them would have the same compact form. The rotations therefore map the space of the components
/// onto itself, and a compact form is rotated there. Distances of compact forms distinguish classes better than
/// distances of signatures; the classes need not be known.
class SignatureProjection {
public:
  SignatureProjection() = default;

  /// \param signatures S x N, one reference shape per column, N >= 1.
  /// \throws std::invalid_argument for no shape, or signatures of zeros.
  static SignatureProjection fit(const Eigen::MatrixXf& signatures, const ProjectionOptions& options = {},
                                 SignatureRotation rotate = rotateSignature);

  bool empty() const { return basis_.size() == 0; }
  int numDimensions() const { return static_cast<int>(basis_.cols()); }

  /// \param signatures S x M, S as in fit().
  /// \return compact forms, numDimensions() x M, columns of unit norm.
  /// \throws std::invalid_argument for another S.
  Eigen::MatrixXf project(const Eigen::Ref<const Eigen::MatrixXf>& signatures) const;

  /// \param compact numDimensions() x M, from project().
  /// \return numDimensions() x 24 M: for each compact form its 24 rotations, the identity first, see rotateSignature().
  /// \throws std::invalid_argument for another number of rows.
  Eigen::MatrixXf rotations(const Eigen::Ref<const Eigen::MatrixXf>& compact) const;

  /// \return all numbers of the projection, to be stored: basis, rotations.
  std::vector<float> toValues() const;
  /// \param values values from toValues() of a projection of shape signatures.
  /// \throws std::invalid_argument for another number of values.
  static SignatureProjection fromValues(const std::vector<float>& values);

private:
  Eigen::MatrixXf basis_;                   // S x K, whitening included
  std::vector<Eigen::MatrixXf> rotations_;  // 24, K x K
};

}  // namespace pcl_symmetry
