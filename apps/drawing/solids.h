/// Solids given by how far a point is from them, and their surface as a mesh: shapes of our own for pictures.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <vector>

namespace pcl_symmetry::apps {

/// About the distance of a point from the surface, negative inside.
using Solid = std::function<double(const Eigen::Vector3d&)>;

Solid ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half_axes);

/// A box with rounded edges.
/// \param half_sizes with the rounding.
/// \param rounding radius, >= 0.
Solid box(const Eigen::Vector3d& center, const Eigen::Vector3d& half_sizes, double rounding = 0.0);

/// About an axis along y.
Solid wheel(const Eigen::Vector3d& center, double radius, double half_width);

/// Along a cubic Bezier curve.
/// \param from,to radii at its ends, linear between.
Solid tube(const std::array<Eigen::Vector3d, 4>& control, double from, double to);

/// A ring about z.
Solid ring(const Eigen::Vector3d& center, double radius, double thickness);

Solid common(const Solid& a, const Solid& b);

/// What is in one of them, with a fillet between.
/// \param fillet its size, > 0.
Solid joined(const std::vector<Solid>& parts, double fillet);

/// The surface as triangles.
/// \param bounds of the solid.
/// \param num_cells along its longest edge.
pcl::PolygonMesh surfaceOf(const Solid& solid, const Eigen::AlignedBox3d& bounds, int num_cells);

}  // namespace pcl_symmetry::apps
