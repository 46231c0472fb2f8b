/// Common geometry of pictures and pages: the rectangles of planes, the lines of axes, and the shading of points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

#include "pcl_symmetry/core/point_set.h"
#include "pictures/picture.h"

namespace pcl_symmetry::apps {

/// Moves the scene to the origin and scales it to unit size, as the clipping planes and single-precision buffers of
/// renderers require.
struct Normalization {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double scale = 1;
  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const { return (point - center) * scale; }
};

/// \throws InputError if no point is finite.
Normalization normalizationOf(const PictureScene& scene);

/// \return the corners of the rectangle in the plane, along the principal axes of the points' projections; or of a
/// square if the patch has a size of its own.
std::array<Eigen::Vector3d, 4> patchCorners(const PlanePatch& plane, const PictureScene& scene);

/// \return the ends of the line: it extends a tenth beyond the points, unless it has a length of its own.
std::pair<Eigen::Vector3d, Eigen::Vector3d> axisEnds(const AxisLine& axis, const PictureScene& scene);

// Greatest number of points that are shaded; more points show their shape by their density.
constexpr std::size_t kMaxShadedPoints = 200'000;

/// \return 3 x N, unit, of arbitrary sign, one for each point; not finite where the point is not, and for clouds of
/// fewer than 16 or more than kMaxShadedPoints points.
Points pointNormals(const Cloud& points, const Normalization& normalize);

/// \return the color of a point in a panel, before shading.
Eigen::Vector3d pointColor(const PicturePanel& panel, std::size_t point);

/// Brightness of a point: least + range * |cosine between normal and view|.
struct PointShade {
  double least, range;
};

/// \param colored whether points are colored by support or segments, which have to stay legible.
PointShade shadeOf(bool colored);

const Eigen::Vector3d kPlainPointColor(0.30, 0.38, 0.52);
const Eigen::Vector3d kPlainMeshColor(0.86, 0.86, 0.88);

}  // namespace pcl_symmetry::apps
