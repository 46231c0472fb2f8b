/// The colors of a surface, from its vertices or from a texture, and which symmetries of a shape keep them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "io/shape_input.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// Points of a surface, one color each.
struct SurfaceColors {
  Points points;         ///< positions minus the shift of the shape
  Eigen::Matrix3Xf rgb;  ///< sRGB in [0, 1]
};

/// Whether a file has colors for its vertices, or coordinates in a texture.
bool hasColors(const Shape& shape);

/// The vertices with their colors. If a PLY file names a texture in the comment "TextureFile NAME", as the models of
/// the BOP benchmark do, points of its triangles with the colors of that image, which is in the same folder.
/// \return nothing if the file has neither.
/// \throws InputError if the texture cannot be read.
std::optional<SurfaceColors> surfaceColors(const Shape& shape, const std::string& path);

/// The greatest group among the symmetries that keeps the colors.
/// \param colors at least one.
/// \param points points of the surface, 3 x N, finite, N >= 1, in the frame of the colors.
/// \param tolerance difference in CIELAB.
ObjectSymmetries keepingColors(const ObjectSymmetries& found, const SurfaceColors& colors, const Points& points,
                               double tolerance);

}  // namespace pcl_symmetry::apps
