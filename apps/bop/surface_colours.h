/// The colours of a surface, from its vertices or from a texture.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "io/shape_input.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::apps {

/// Points of a surface, one colour each.
struct SurfaceColours {
  Points points;         ///< minus the shift of the shape
  Eigen::Matrix3Xf rgb;  ///< sRGB in [0, 1]
};

/// Whether a file has colours for its vertices, or coordinates in a texture.
bool hasColours(const Shape& shape);

/// The vertices with their colours; or, where a PLY file names a texture in the comment "TextureFile NAME", as the
/// models of the BOP benchmark do, points of its triangles with the colours of that picture, which lies beside the
/// file.
/// \return nothing where the file has neither.
/// \throws InputError where the texture cannot be read.
std::optional<SurfaceColours> surfaceColours(const Shape& shape, const std::string& path);

}  // namespace pcl_symmetry::apps
