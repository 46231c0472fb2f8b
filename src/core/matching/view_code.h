#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/matching/view_signature.h"

namespace pcl_symmetry {

/// Number of values of a code.
constexpr int kViewCodeSize = 24;

/// A view in a few bytes, independent of rotations in the image.
struct ViewCode {
  std::array<std::int8_t, kViewCodeSize> values;  ///< values in steps of kViewCodeStep
  std::int16_t size;                              ///< logarithm of View::radius in steps of kViewSizeStep
};
/// Step of the values of a code, which are components of a unit vector.
constexpr float kViewCodeStep = 1.0f / 127.0f;
/// Step of the logarithm of a radius: 16 bits hold a factor of 1e14.
constexpr float kViewSizeStep = 1e-3f;

/// Codes of the views of one shape: value by value for all views, then sizes with their low bytes first.
/// \return (kViewCodeSize + 2) * number of views bytes.
std::string packedViewCodes(const std::vector<ViewCode>& codes);

/// Makes codes: the principal components of the magnitudes of views, see magnitudesOf().
class ViewCoder {
public:
  ViewCoder() = default;
  static ViewCoder fit(const std::vector<View>& views);

  ViewCode codeOf(const View& view) const;
  /// \return packedViewCodes() of the views of a shape.
  std::string codesOf(const std::vector<View>& views) const;

  /// \return (kViewCodeSize + 1) * kViewMagnitudes numbers: mean and basis.
  Eigen::MatrixXf toValues() const;
  /// \throws std::invalid_argument for a matrix of another size.
  static ViewCoder fromValues(const Eigen::MatrixXf& values);

private:
  Eigen::VectorXf mean_;
  Eigen::MatrixXf basis_;  // kViewMagnitudes x kViewCodeSize, orthonormal columns
};

/// Finds the shapes that a scan can show by the codes of their views; ViewIndex then compares them in full.
///
/// All codes are compared. 100 000 shapes have eight million codes: 208 MB, and milliseconds per query.
class ViewCodeIndex {
public:
  /// \param codes codes of a shape, see packedViewCodes().
  /// \throws std::invalid_argument for another number of bytes.
  void add(const std::string& codes);

  std::size_t numShapes() const { return begins_.size() - 1; }

  /// \param count >= 0.
  /// \return the numbers of the nearest shapes, ascending, at most \p count. Shapes without views are never found.
  std::vector<int> nearest(const ViewCode& scan, int count, int num_threads) const;

private:
  std::vector<std::int8_t> codes_;         // codes of all shapes, one after the other
  std::vector<std::size_t> begins_ = {0};  // where each shape begins, and the end, in views
};

/// A shape that looks like a scan from some side.
struct ShapeOfView {
  int shape;        ///< number of the shape, in the order in which shapes were added
  double distance;  ///< mean distance of its two nearest views, including the difference of sizes
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< poses of the nearest views, nearest first
};

/// Finds the shapes that a scan may show, and their poses.
class ViewIndex {
public:
  /// \param views views of a shape, from viewsAround().
  void add(const std::vector<View>& views);

  /// \return nearest first, at most \p num_nearest. Shapes without views are never found.
  std::vector<ShapeOfView> nearest(const View& scan, int num_nearest = 10, int num_threads = 0) const;

private:
  std::vector<std::vector<View>> shapes_;
};

}  // namespace pcl_symmetry
