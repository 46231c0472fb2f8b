#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// What a range scanner saw: space in front of the surface on each ray is free, space behind it unknown.
///
/// A picture of depths with the projection that made it. A reflected point that lands in free space speaks against the
/// plane; one in unknown space says nothing.
class Visibility {
public:
  using Projection = Eigen::Matrix<double, 3, 4>;

  /// Depths of pixels that are no distance.
  static constexpr float kBackground = std::numeric_limits<float>::infinity();  ///< the ray met nothing: all free
  static constexpr float kNoRay = -std::numeric_limits<float>::infinity();      ///< nothing is known about the ray

  /// The rays of an organized cloud.
  /// \param projection takes a homogeneous point of the input frame to (u w, v w, w) with w its depth, input units.
  /// \param depths width * height depths, row by row, pixel (u, v) about its integer coordinates.
  /// \throws std::invalid_argument for a picture without pixels or a size that does not fit.
  /// \param outside depth of rays beyond the picture.
  Visibility(const Projection& projection, int width, int height, std::vector<float> depths, float outside = kNoRay);

  /// A range image of points without order: the nearest point in each pixel, pixels as wide as the points are apart as
  /// seen from there, small gaps between the points closed.
  /// \param points 3 x N, finite, N >= 1. \param viewpoint in the same frame.
  /// \return nothing where the points do not lie in a cone of 75 degrees around one direction: seen from inside.
  static std::optional<Visibility> fromPoints(const PointsRef& points, const Eigen::Vector3d& viewpoint);

  /// How far behind the surface on its ray a point lies, input units: < 0 in free space; -infinity in front of nothing,
  /// +infinity where no ray passed.
  double depthBehind(const Eigen::Vector3d& x) const;

  /// Share of the points that lie more than \p margin behind what is seen on their ray. Seen from where they were
  /// measured it is near 0: each ray meets the cloud once.
  double hiddenShare(const PointsRef& points, double margin) const;

  /// The same for coordinates (x - center) / scale.
  Visibility normalized(const Eigen::Vector3d& center, double scale) const;

  /// Where the rays meet, in the frame of the points.
  Eigen::Vector3d viewpoint() const;

  int width() const { return width_; }
  int height() const { return height_; }
  float depth(int u, int v) const { return depths_[static_cast<std::size_t>(v) * width_ + u]; }

private:
  Projection projection_;
  int width_;
  int height_;
  std::vector<float> depths_;
  float outside_;
};

}  // namespace pcl_symmetry
