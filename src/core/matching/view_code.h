#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/matching/view_signature.h"

namespace pcl_symmetry {

/// Values of a code. measured: of 274 scans of models of the Princeton Shape Benchmark (fold 1 of the training half),
/// the scanned model is the nearest of 902 for 74 % with 24 values and 70 % with 16, and among the nearest 50 for 99.6
/// and 100 %.
constexpr int kViewCodeSize = 24;

/// A view in few bytes, the same for all turns of its picture.
struct ViewCode {
  std::array<std::int8_t, kViewCodeSize> values;  ///< in steps of kViewCodeStep
  std::int16_t size;                              ///< logarithm of View::radius in steps of kViewSizeStep
};
/// Step of the values of a code. derived: components of a vector of magnitudes of unit norm lie within 1 of those of
/// another.
constexpr float kViewCodeStep = 1.0f / 127.0f;
/// Step of the logarithm of a radius. chosen: 0.1 %; half and twice change no order, and 16 bits hold a factor of 1e14.
constexpr float kViewSizeStep = 1e-3f;

/// Codes of the views of one shape: value by value for all views, then sizes with their low bytes first.
/// \return (kViewCodeSize + 2) * number of views bytes.
std::string packedViewCodes(const std::vector<ViewCode>& codes);

/// Makes codes: the principal components of the magnitudes of views, see turnlessValues().
class ViewCoder {
public:
  ViewCoder() = default;
  /// \param views of shapes, at least one.
  static ViewCoder fit(const std::vector<View>& views);

  ViewCode codeOf(const View& view) const;
  /// \return packedViewCodes() of the views of a shape.
  std::string codesOf(const std::vector<View>& views) const;

  /// \return (kViewCodeSize + 1) * kTurnlessViewSize numbers: mean and basis.
  Eigen::MatrixXf toValues() const;
  /// \throws std::invalid_argument for a matrix of another size.
  static ViewCoder fromValues(const Eigen::MatrixXf& values);

private:
  Eigen::VectorXf mean_;
  Eigen::MatrixXf basis_;  // kTurnlessViewSize x kViewCodeSize, orthonormal columns
};

}  // namespace pcl_symmetry
