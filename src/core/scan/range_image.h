#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Which points a range image contains.
enum class FieldOfView {
  Cone,     ///< points within 75 degrees of the direction in which the camera looks
  CubeFace  ///< points in a square of 90 degrees, so that six images cover all directions
};

/// Points in the image plane at depth one.
struct SeenPositions {
  std::vector<Eigen::Array2d> positions;
  std::vector<float> depths;  ///< depths along the direction in which the camera looks, input units
};

/// The pixels of a range image. Pixel (u, v) contains the positions around its integer coordinates; the filled pixels
/// are surrounded by at least one empty one.
struct PixelGrid {
  Eigen::Array2d low;  ///< least coordinates of the positions
  double size;         ///< size of a pixel at depth one
  int width = 1, height = 1;

  int column(const Eigen::Array2d& p) const { return static_cast<int>((p.x() - low.x()) / size) + 1; }
  int row(const Eigen::Array2d& p) const { return static_cast<int>((p.y() - low.y()) / size) + 1; }
  std::size_t at(const Eigen::Array2d& p) const { return static_cast<std::size_t>(row(p)) * width + column(p); }
  std::size_t numPixels() const { return static_cast<std::size_t>(width) * height; }

  /// Maps positions at depth one to pixels.
  Eigen::Matrix3d toPixels() const {
    Eigen::Matrix3d to_pixels = Eigen::Matrix3d::Identity();
    to_pixels(0, 0) = to_pixels(1, 1) = 1.0 / size;
    to_pixels(0, 2) = 0.5 - low.x() / size;
    to_pixels(1, 2) = 0.5 - low.y() / size;
    return to_pixels;
  }
};

/// Depths of the nearest point in each pixel; Visibility::kBackground where there is none.
struct RangeImage {
  PixelGrid grid;
  std::vector<float> depths;
};

/// \param points 3 x N, finite.
/// \param R_camera_input rows right, down and forward in the frame of the points.
/// \return the points that lie in the field of view.
SeenPositions positionsSeen(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                            const Eigen::Matrix3d& R_camera_input, FieldOfView field);

/// A range image of the unorganized points of one object. The size of the pixels follows the distance between the
/// points in the image; gaps between the points are closed. Empty pixels are background.
/// \param seen at least one position.
/// \param max_pixels number of pixels above which they are enlarged, >= 16.
RangeImage rangeImage(const SeenPositions& seen, std::size_t max_pixels);

/// The same for a scene. If its rays are denser in one direction than across it, as in the rings of a LiDAR, pixels are
/// as small as the denser spacing, and the gaps between the rings are bridged. Empty pixels beyond the measured part of
/// the image, with filled pixels in fewer than three of the four directions along rows and columns, are
/// Visibility::kNoRay.
/// \param seen at least one position.
/// \param max_pixels number of pixels above which they are enlarged, >= 16.
RangeImage sceneRangeImage(const SeenPositions& seen, std::size_t max_pixels);

/// A side of the image of a camera that cut the object off: no ray passed where normal . p > offset.
struct FrameSide {
  Eigen::Vector2d normal;  ///< unit, pointing out of the image
  double offset;           ///< offset of the line, units of the positions
};

/// Finds the sides of the image that cut the object, from the points alone. Not in the paper.
///
/// Like pixels, the positions of the points of a scan lie in rows and columns. Where the image ends, its last row is as
/// long as those before it; where the object ends, rows become shorter. A straight edge of the object along a row looks
/// like a side of the image: space beyond it then counts as unknown, which loses evidence but adds none.
/// \param positions positions of points in the image plane at depth one.
/// \return at most four sides; none if the positions form no grid, as for a random subset of the points.
std::vector<FrameSide> frameSides(const std::vector<Eigen::Array2d>& positions);

/// Determines from the points of a scene whether they were measured from a viewpoint. Unlike the points of one object,
/// a scene may surround the viewpoint.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \param max_pixels as in Visibility::ofScene().
/// \return the space seen from the viewpoint; nothing if the points were not measured from there.
std::optional<Visibility> sceneSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        std::size_t max_pixels);

/// \param points 3 x N, finite, N >= 1.
/// \param viewpoint in the frame of the points.
/// \return why the points cannot have been measured from a viewpoint that a user gave; empty if they can.
std::string whyNotSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// Limits of a single view, as shares of the points.
struct SingleViewLimits {
  double max_hidden;   ///< greatest share of points well behind others
  double max_layered;  ///< greatest layeredShare()
};

/// spaceSeenFrom() of visibility.h with other limits.
std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits);

/// Share of the points that form layers as seen from a viewpoint.
///
/// A point is layered if its neighbor in the image is much farther away or much nearer, and the roughness of the
/// surface does not explain it. A scan has one layer except at its silhouettes (0.1 of the points, up to 0.2 with
/// noise); an object that is seen from all sides has two or more.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \return a value in [0, 1]; 0 for fewer than two points.
double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// How much of the outline of a cloud the image border cuts off.
/// \return share of the directions of the outline, seen from the viewpoint, in which the sensor's image ends beside the
/// cloud; 0 for an image made from points.
double cutShare(const PointsRef& points, const Visibility& seen);

/// Whether the space at a point and beside it is free.
/// \param margin least depth of the point in front of the visible surface, units of the points.
/// \param rim distance beside the point within which space must be free, too; 0 = only at the point.
bool isFreeSpace(const Visibility& seen, const Eigen::Vector3d& x, double margin, double rim);

}  // namespace pcl_symmetry
