/// The colors of a surface, from its vertices or from a texture, and which symmetries of a shape keep them.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "io/shape_input.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// Points of a surface, one color each.
struct SurfaceColors {
  Points points;         ///< minus the shift of the shape
  Eigen::Matrix3Xf rgb;  ///< sRGB in [0, 1]
};

/// Whether a file has colors for its vertices, or coordinates in a texture.
bool hasColors(const Shape& shape);

/// The vertices with their colors; or, where a PLY file names a texture in the comment "TextureFile NAME", as the
/// models of the BOP benchmark do, points of its triangles with the colors of that picture, which lies beside the
/// file.
/// \return nothing where the file has neither.
/// \throws InputError where the texture cannot be read.
std::optional<SurfaceColors> surfaceColors(const Shape& shape, const std::string& path);

/// Difference of colors in CIELAB that counts as none.
constexpr double kColorTolerance = 12.0;

/// CIELAB of an sRGB color under D65.
/// \param rgb in [0, 1].
/// \return L in [0, 100], a, b.
Eigen::Vector3f labOf(const Eigen::Vector3f& rgb);

/// Samples of a surface with the colors next to them.
class ColoredSurface {
public:
  /// \param colors at least one.
  /// \param points 3 x N, finite, N >= 1, in the frame of the colors.
  /// \param tolerance difference in CIELAB.
  ColoredSurface(const SurfaceColors& colors, Points points, double tolerance);

  /// Share of the surface on which a motion changes the color by more than the tolerance.
  double changedShare(const Eigen::Isometry3d& motion) const;

  /// Whether a motion changes the color of no more than 5 % of the surface.
  bool keeps(const Eigen::Isometry3d& motion) const;

private:
  Points points_;
  Eigen::Matrix3Xf lab_;
  double tolerance_;
  ClosestPointSearch::Ptr search_;
};

/// The greatest group among the symmetries that keeps the colors.
ObjectSymmetries keepingColors(const ObjectSymmetries& found, const ColoredSurface& surface);

}  // namespace pcl_symmetry::apps
