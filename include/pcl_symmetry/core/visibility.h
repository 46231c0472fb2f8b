#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// What a range scanner saw: space in front of the surface on each ray is free, space behind it is unknown.
///
/// It holds one or several depth images with their projections: space is free if any of them shows it to be free. A
/// reflected point in free space counts against the plane; a reflected point in unknown space is uninformative.
/// Departure from the paper: it treats scans as whole objects, whose best planes then often lie beside the true ones.
///
/// Copies share their depth images.
class Visibility {
public:
  using Projection = Eigen::Matrix<double, 3, 4>;  ///< homogeneous points to pixels and depth

  /// Depth of a ray that met nothing: all of its space is free. Farther than every point.
  static constexpr float kBackground = std::numeric_limits<float>::infinity();
  /// Depth of a pixel without a ray: all of its space is unknown. Nearer than every point.
  static constexpr float kNoRay = -std::numeric_limits<float>::infinity();

  /// The rays of an organized cloud or a depth image.
  /// \param projection takes a homogeneous point of the input frame to (u w, v w, w) with w its depth, input units.
  /// \param width,height number of columns and rows, >= 1.
  /// \param depths width * height depths, row by row, input units; pixel (u, v) covers u - 1/2 to u + 1/2.
  /// \param outside depth of rays beyond the image: kNoRay or kBackground.
  /// \throws std::invalid_argument for an image without pixels, or a number of depths that does not fit.
  Visibility(const Projection& projection, int width, int height, std::vector<float> depths, float outside = kNoRay);

  /// A range image of points without order: the nearest point in each pixel. The size of the pixels follows the
  /// distance between the points in the image; small gaps between the points are closed. Space beside the points is
  /// free, except beyond a side of the scanner's image: if the last row of points is as long as those before it, the
  /// image border cut the object off.
  /// \param points 3 x N, finite.
  /// \param viewpoint in the frame of the points.
  /// \return nothing without a point, with one that is not finite, or if the viewpoint is among the points: they do not
  /// lie in a cone of 75 degrees around one direction.
  static std::optional<Visibility> fromPoints(const PointsRef& points, const Eigen::Vector3d& viewpoint);

  /// The range image of a scene, of which the analyzed points are a part: whatever hides them is in it too. Space
  /// beyond the image is unknown. Points all around the viewpoint give six images, the faces of a cube; points in a
  /// cone of 75 degrees around one direction give one.
  /// \param points 3 x N, finite: all that the scanner measured.
  /// \param viewpoint in the frame of the points.
  /// \param max_pixels greatest number of pixels of each image, >= 16: larger scenes get larger pixels. An image takes
  /// four bytes a pixel.
  /// \return nothing without a point other than the viewpoint.
  static std::optional<Visibility> ofScene(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                           std::size_t max_pixels = kMaxPixels);

  /// The views of several scanners of one scene: space is free if it is free for any of them.
  /// \param views in one frame, at least one.
  /// \throws std::invalid_argument without a view.
  static Visibility together(const std::vector<Visibility>& views);

  /// This visibility for objects on a table: no object reaches into it, so that space behind its surface counts as
  /// free.
  /// \param support unit normal n toward the objects, then d: n . x + d = 0 on the surface, frame of the points.
  /// \param margin distance by which objects may seem to reach into the table, input units, >= 0.
  Visibility withSupport(const Eigen::Vector4d& support, double margin) const;

  /// This visibility with errors of the inverse depths, which for stereo and structured light are equal at all depths.
  /// \param inverse_depth_error standard deviation, 1 / input units, >= 0; 0 = not known.
  Visibility withDepthErrors(double inverse_depth_error) const;

  /// \param x in the frame of the points.
  /// \return standard deviation of the errors of a depth measured there, input units; 0 where it is not known.
  double depthError(const Eigen::Vector3d& x) const;

  /// The least tolerance that a depth camera resolves: the reflection of a point and the surface that it is compared
  /// with both have the error of a depth, and 97 % of the points of a true symmetry are to be within it.
  /// \param points 3 x N, N >= 1, in the frame of the points.
  /// \return input units; 0 where the errors are not known.
  double resolvedTolerance(const PointsRef& points) const;

  /// \return the planes of withSupport() with their margins: no object lies below n . x + d = 0.
  const std::vector<Eigen::Vector4d>& supports() const { return supports_; }

  /// Greatest number of pixels of an image made from points: 4 MB per image.
  static constexpr std::size_t kMaxPixels = 1u << 20;

  /// \param x in the frame of the points.
  /// \return distance of the point behind the surface, along its ray, input units: negative in free space, -infinity if
  /// the ray met no surface, +infinity if no ray passed.
  double depthBehind(const Eigen::Vector3d& x) const;

  /// \param x in the frame of the points.
  /// \return whether an image has a pixel there, with or without a depth. Images made from points have no border: true
  /// for all points in front of them.
  bool isInPicture(const Eigen::Vector3d& x) const;

  /// \param points 3 x M, in the frame of the points.
  /// \return M values, 1 where depthBehind() is negative, in free space.
  std::vector<char> areFree(const Eigen::Matrix3Xd& points) const;

  /// The share of a cloud that is hidden by the cloud itself.
  /// \param points 3 x N, finite, N >= 1.
  /// \param margin input units.
  /// \return share of the points that lie more than the margin behind the surface on their ray. From the viewpoint of a
  /// scan it is close to 0, because each ray meets the cloud once.
  double hiddenShare(const PointsRef& points, double margin) const;

  /// \return the same visibility for coordinates (x - center) / scale.
  Visibility normalized(const Eigen::Vector3d& center, double scale) const;

  /// \return the point where all rays of the first image meet, in the frame of the points.
  Eigen::Vector3d viewpoint() const;

  /// \return number of depth images, >= 1.
  std::size_t numPictures() const { return depth_views_.size(); }
  /// Columns and rows of the first image.
  int width() const { return depth_views_.front().width; }
  int height() const { return depth_views_.front().height; }  ///< rows
  /// \return depth of a pixel of the first image, input units.
  float depth(int u, int v) const { return depth_views_.front().depth(u, v); }

private:
  struct DepthView {
    Projection projection;
    int width, height;
    std::shared_ptr<const std::vector<float>> depths;  // in units of the original image
    float outside;
    double unit = 1.0;                 // unit of this frame, in units of the depths
    double inverse_depth_error = 0.0;  // standard deviation, 1 / units of the depths
    // Made from points: such an image ends where the points do, unlike the image of the sensor.
    bool is_of_points = false;
    // Lines in homogeneous pixels along which the image border cut the object: no ray passed where the product is
    // positive.
    std::vector<Eigen::Vector3d> sides;

    float depth(int u, int v) const {
      return static_cast<float>((*depths)[static_cast<std::size_t>(v) * width + u] / unit);
    }
    /// \param image the point, mapped by the projection.
    double depthBehind(const Eigen::Vector3d& image) const;
  };

  Visibility() = default;

  std::vector<DepthView> depth_views_;
  std::vector<Eigen::Vector4d> supports_;  // no object lies behind these planes
};

/// Determines from the points whether they were measured from a viewpoint: they lie in front of it, in one layer, and
/// hardly any is behind others. An open surface that is completely visible from there passes, too.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \return the space seen from the viewpoint; nothing if the points were not measured from there.
std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint);

}  // namespace pcl_symmetry
