#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Which points a picture holds.
enum class FieldOfView {
  Cone,     ///< within 75 degrees of the direction that the camera looks along
  CubeFace  ///< a square of 90 degrees: six of them see all around
};

/// Points in the picture plane at depth one.
struct SeenPositions {
  std::vector<Eigen::Array2d> positions;
  std::vector<float> depths;  ///< along the direction that the camera looks along, input units
};

/// The pixels of a picture. Pixel (u, v) contains the positions about its integer coordinates; one empty pixel at least
/// surrounds the filled ones.
struct PixelGrid {
  Eigen::Array2d low;  ///< least coordinates of the positions
  double size;         ///< of a pixel, at depth one
  int width = 1, height = 1;

  int column(const Eigen::Array2d& p) const { return static_cast<int>((p.x() - low.x()) / size) + 1; }
  int row(const Eigen::Array2d& p) const { return static_cast<int>((p.y() - low.y()) / size) + 1; }
  std::size_t at(const Eigen::Array2d& p) const { return static_cast<std::size_t>(row(p)) * width + column(p); }
  std::size_t numPixels() const { return static_cast<std::size_t>(width) * height; }

  /// Takes positions at depth one to pixels.
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
/// \return those of the points that lie in the field of view.
SeenPositions positionsSeen(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                            const Eigen::Matrix3d& R_camera_input, FieldOfView field);

/// A range image of the points of one object, without order. The size of the pixels follows the distance between the
/// points in the picture; gaps between the points are closed. Empty pixels are background.
/// \param seen at least one position.
/// \param max_pixels least number of pixels that make them larger, >= 16.
RangeImage rangeImage(const SeenPositions& seen, std::size_t max_pixels);

/// The same for a scene. Where its rays are denser in one direction than across, as in the rings of a LiDAR scanner,
/// pixels are as small as the denser distance, and the gaps between the rings are bridged. Empty pixels beyond the
/// measured part of the picture are Visibility::kNoRay: those with filled pixels in fewer than three of the four
/// directions along rows and columns.
/// \param seen at least one position.
/// \param max_pixels least number of pixels that make them larger, >= 16.
RangeImage sceneRangeImage(const SeenPositions& seen, std::size_t max_pixels);

/// A side of the picture of a camera, at which the object was cut off: no ray passed where normal . p > offset.
struct FrameSide {
  Eigen::Vector2d normal;  ///< unit, out of the picture
  double offset;           ///< of the line, units of the positions
};

/// Finds the sides of the picture that cut the object, from the points alone.
///
/// Not in the paper. Pixels lie in rows and columns, and so do the positions of the points of a scan. Where the picture
/// ends, its last row is as long as those before it; where the object ends, rows become shorter. A straight edge of the
/// object that lies along a row looks like a side of the picture: space beyond it is then unknown, which loses evidence
/// but adds none.
/// \param positions of points in the picture plane at depth one.
/// \return at most four sides; none where the positions are in no grid, as those of a part of the points drawn at random.
std::vector<FrameSide> frameSides(const std::vector<Eigen::Array2d>& positions);

/// Finds out from the points of a scene whether they were measured from a viewpoint. Unlike that of one object, a scene
/// may surround the viewpoint.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \param max_pixels as in Visibility::ofScene().
/// \return the space seen from the viewpoint; nothing if the points were not measured from there.
std::optional<Visibility> sceneSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        std::size_t max_pixels);

/// \param points 3 x N, finite, N >= 1.
/// \param viewpoint in the frame of the points.
/// \return why the points cannot have been measured from the viewpoint, for a user who says so; empty where they can.
std::string whyNotSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// What a single view may show at most, shares of the points.
struct SingleViewLimits {
  double max_hidden;   ///< that lie well behind others
  double max_layered;  ///< layeredShare()
};

/// spaceSeenFrom() of visibility.h with other limits.
std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits);

/// Share of the points that form layers as seen from a viewpoint.
///
/// A point is layered if the next point in the picture is much farther away or much nearer, and the roughness of the
/// surface does not explain it. A scan has one layer except at its silhouettes (0.1 of the points, up to 0.2 with
/// noise); an object that is known from all sides has two or more.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \return a value in [0, 1]; 0 for fewer than two points.
double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// How much of a cloud the picture cut off.
/// \param points 3 x N, finite, N >= 1, seen within 75 degrees of one direction.
/// \param margin where the picture is looked up beyond the outermost points, share of their distance from the middle.
/// \return share of the directions of the outline, seen from the viewpoint, in which the sensor's picture ends beside the
/// cloud; 0 of a picture that was made of points.
double cutShare(const PointsRef& points, const Visibility& seen, double margin);

/// Whether a scanner saw that nothing is at a point, nor beside it.
/// \param margin least depth of the point before what was seen, units of the points.
/// \param rim how far beside the point nothing must have been seen either; 0 = only at the point.
bool isSeenEmpty(const Visibility& seen, const Eigen::Vector3d& x, double margin, double rim);

}  // namespace pcl_symmetry
