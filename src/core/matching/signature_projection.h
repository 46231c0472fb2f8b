#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/descriptors/shape_signature.h"

namespace pcl_symmetry {

struct ProjectionOptions {
  int num_dimensions = 256;  ///< of the compact form, >= 1; fewer where the shapes span no more
  /// Coefficients are divided by their standard deviation to this power, in [0, 1]: what all shapes have in common
  /// counts less.
  double whitening = 0.4;
  int num_iterations = 4;  ///< of the search for the greatest variances, >= 1
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Turns a signature or another descriptor by one of the axisRotations().
using SignatureRotation = void (*)(const float* values, int rotation, float* rotated);

/// The compact form of signatures: their principal components, with all rotations of axes at the price of one.
///
/// The components are those of the reference shapes in all 24 rotations of their axes. So the space that they span is
/// mapped onto itself by these, and a signature is projected once and turned there. Distances of compact forms tell
/// shapes of a kind from others better than those of the signatures; no kinds have to be known for that.
class SignatureProjection {
public:
  SignatureProjection() = default;

  /// \param signatures S x N, one reference shape a column, N >= 1; 200 are enough for any number of shapes.
  /// \param rotate turns such a column. \throws std::invalid_argument for bad options, too few shapes, or shapes that
  /// are all alike.
  static SignatureProjection fit(const Eigen::MatrixXf& signatures, const ProjectionOptions& options = {},
                                 SignatureRotation rotate = rotateSignature);

  bool empty() const { return basis_.size() == 0; }
  int numDimensions() const { return static_cast<int>(basis_.cols()); }

  /// \param signatures S x M, S as in fit(). \return numDimensions() x M, columns of unit norm.
  Eigen::MatrixXf project(const Eigen::Ref<const Eigen::MatrixXf>& signatures) const;

  /// \param compact numDimensions() x M, of project(). \return the compact forms of the 24 rotations of each,
  /// numDimensions() x 24 M, those of the first signature first and its own before others; see rotateSignature().
  Eigen::MatrixXf rotations(const Eigen::Ref<const Eigen::MatrixXf>& compact) const;

  /// All numbers that make up the projection, to be stored. \return and their counterpart.
  std::vector<float> toValues() const;
  /// \throws std::invalid_argument where the values are not those of a projection of signatures.
  static SignatureProjection fromValues(const std::vector<float>& values);

private:
  Eigen::VectorXf mean_;                // S
  Eigen::MatrixXf basis_;               // S x K, whitening included
  std::vector<Eigen::MatrixXf> turns_;  // 24, K x K
};

/// The least distance of a shape to another one in any of their frames and any rotation of axes.
/// \param rotations of the one, see SignatureProjection::rotations(). \param compact of the other. \return in [0, 2].
float signatureDistance(const Eigen::MatrixXf& rotations, const Eigen::Ref<const Eigen::MatrixXf>& compact);

}  // namespace pcl_symmetry
