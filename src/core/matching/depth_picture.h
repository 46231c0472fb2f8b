#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace pcl_symmetry {

/// Points by coordinates, N x 3: all x, then all y, then all z.
using PointColumns = Eigen::Matrix<float, Eigen::Dynamic, 3>;

/// Points seen from far away: the nearest depth in each cell of a square picture. The viewer looks along z.
class DepthPicture {
public:
  /// Depth of a cell where nothing is seen.
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  /// \param side cells along each side, >= 1.
  /// \param corner least x and y of the picture.
  /// \param cell width of a cell, > 0, units of the points.
  DepthPicture(int side, const Eigen::Array2f& corner, float cell)
      : side_(side), corner_(corner), cell_(cell), depths_(static_cast<std::size_t>(side) * side, kNothing) {}

  /// Points beyond the picture are left out.
  void add(const PointColumns& points);

  int side() const { return side_; }
  Eigen::Array2f center(int u, int v) const { return corner_ + cell_ * (Eigen::Array2i(u, v).cast<float>() + 0.5f); }
  /// \return kNothing also beyond the picture.
  float depth(int u, int v) const {
    const bool inside = u >= 0 && v >= 0 && u < side_ && v < side_;
    return inside ? depths_[static_cast<std::size_t>(v * side_ + u)] : kNothing;
  }

private:
  int side_;
  Eigen::Array2f corner_;
  float cell_;
  std::vector<float> depths_;  // x fastest
};

/// The outline of what is seen.
struct ViewOutline {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of the cells inside the outline, and of their depths
  double radius = 0.0;  ///< root mean square distance of the inside from the middle, in the picture
};

/// \param in_view N >= 1 points, z away from the viewer.
/// \throws std::invalid_argument for points that are seen as one.
ViewOutline outlineOf(const PointColumns& in_view);

/// A picture smoothed over neighboring cells, sampled between their centers.
class SmoothPicture {
public:
  /// \param middle the depth that becomes 0.
  /// \param unit of depths, > 0.
  SmoothPicture(const DepthPicture& picture, float middle, float unit);

  /// \param at in cells from the corner.
  /// \return outline (1 inside) and depth, both 0 beyond the picture.
  Eigen::Array2f sample(const Eigen::Array2f& at) const {
    const Eigen::Array2f corner = (at - 0.5f).floor(), t = at - 0.5f - corner;
    const int u = static_cast<int>(corner.x()), v = static_cast<int>(corner.y());
    return (1.0f - t.y()) * ((1.0f - t.x()) * value(u, v) + t.x() * value(u + 1, v)) +
           t.y() * ((1.0f - t.x()) * value(u, v + 1) + t.x() * value(u + 1, v + 1));
  }

private:
  Eigen::Array2f value(int u, int v) const {
    if (u < 0 || v < 0 || u >= side_ || v >= side_) return Eigen::Array2f::Zero();
    return values_[static_cast<std::size_t>(v * side_ + u)];
  }

  int side_;
  std::vector<Eigen::Array2f> values_;
};

}  // namespace pcl_symmetry
