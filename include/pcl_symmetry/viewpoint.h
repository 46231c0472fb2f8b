#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Where the scanner stood.
struct Viewpoint {
  /** What is known of it. */ enum class Mode {
    Auto,  ///< the data decide, see ViewpointSource
    None,  ///< no viewpoint: the cloud shows the object from all sides
    Given  ///< the scanner stood at `position`
  };
  Mode mode = Mode::Auto;                              ///< how the viewpoint is known
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< input frame and units; used with Mode::Given
};

/// How the viewpoint of an analysis is known. Mode::Auto tries Rays, Stored and Inferred, in this order.
enum class ViewpointSource {
  None,     ///< no viewpoint was used
  Given,    ///< given by the user
  Rays,     ///< from the rows and columns of an organized cloud
  Stored,   ///< from sensor_origin_, and the points can have been seen from there
  Inferred  ///< from the density of the points, which in a scan falls with the slant and the distance of the surface
};

/// \return "none", "given", "rays", "stored" or "inferred".
inline const char* toString(ViewpointSource source) {
  constexpr const char* names[] = {"none", "given", "rays", "stored", "inferred"};
  return names[static_cast<int>(source)];
}

namespace detail {

/// \return the viewpoint.
/// \throws pcl::BadArgumentException for a position that is not finite.
const Viewpoint& checkedViewpoint(const Viewpoint& viewpoint);

/// \return the positions of a cloud with its rows, columns and sensor. For PointXYZ it is the cloud itself, which has
/// to outlive the result.
template <typename PointT>
pcl::PointCloud<pcl::PointXYZ>::ConstPtr positionsOf(const pcl::PointCloud<PointT>& cloud) {
  if constexpr (std::is_same_v<PointT, pcl::PointXYZ>) {
    return {&cloud, [](const void*) {}};
  } else {
    auto positions = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    positions->resize(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) (*positions)[i].getVector3fMap() = cloud[i].getVector3fMap();
    positions->width = cloud.width;
    positions->height = cloud.height;
    positions->sensor_origin_ = cloud.sensor_origin_;
    positions->sensor_orientation_ = cloud.sensor_orientation_;
    return positions;
  }
}

}  // namespace detail

/// What scanners saw of a scene: free, measured and unknown space. It is determined once and shared by the analyses of
/// all objects of the scene: ScanAnalysis::setSeenSpace(), SymmetryDatabase::recognize(), completeBySymmetry().
///
/// Space in front of a surface is free. Space behind any surface, whatever object it belongs to, and outside the image
/// is unknown.
class SeenSpace {
public:
  using ConstPtr = std::shared_ptr<const SeenSpace>;

  SeenSpace() = default;  ///< nothing is known: clouds show their objects from all sides
  /// Takes what a scanner saw.
  /// \param source how the position of the scanner is known.
  SeenSpace(Visibility visibility, ViewpointSource source) : visibility_(std::move(visibility)), source_(source) {}

  /// The space that the scanner of a whole scene saw. An organized cloud shows it by its own pixels, any other cloud by
  /// a range image from the viewpoint. Viewpoint::Mode::Auto uses sensor_origin_ if the scene can have been seen from
  /// there: hardly any point lies behind others. A sensor_origin_ of 0 0 0 is used only if points do not surround it,
  /// because a whole object may lie around the origin.
  /// \param scene all that the scanner measured; points that are not finite are pixels without a point.
  /// \param max_pixels greatest number of pixels of a range image, >= 16; it takes four bytes a pixel. Organized clouds
  /// keep theirs.
  /// \throws pcl::BadArgumentException for another max_pixels.
  template <typename PointT>
  explicit SeenSpace(const pcl::PointCloud<PointT>& scene, const Viewpoint& viewpoint = {},
                     std::size_t max_pixels = Visibility::kMaxPixels)
      : SeenSpace(ofScene(*detail::positionsOf(scene), viewpoint, max_pixels)) {}

  /// The views of several scanners, such as the scans of a turntable in one frame: space is free if it is free for any
  /// of them.
  /// \param spaces those without a viewpoint add nothing.
  static SeenSpace together(const std::vector<SeenSpace>& spaces);

  /// The same for objects on a table, see Visibility::withSupport().
  /// \param support unit normal toward the objects, then d: normal . x + d = 0 on the surface.
  /// \param margin distance by which objects may seem to reach into the table, input units, >= 0.
  SeenSpace withSupport(const Eigen::Vector4d& support, double margin) const;

  /// The same for objects that stand on nothing, or whose support is unknown. Otherwise an analysis of a part of a
  /// scene, selected by setIndices(), searches for the planes that it stands on, unless withSupport() gave one.
  SeenSpace withoutSupport() const;

  /// \return null where there is no viewpoint.
  const Visibility* visibility() const { return visibility_ ? &*visibility_ : nullptr; }
  ViewpointSource source() const { return source_; }  ///< how the viewpoint is known
  /// \return whether an analysis of a part of the scene searches for the planes that it stands on.
  bool asksForSupport() const { return visibility_ && asks_for_support_; }

private:
  static SeenSpace ofScene(const pcl::PointCloud<pcl::PointXYZ>& scene, const Viewpoint& viewpoint,
                           std::size_t max_pixels);

  std::optional<Visibility> visibility_;
  ViewpointSource source_ = ViewpointSource::None;
  bool asks_for_support_ = true;
};

/// Removes the errors of a depth camera from its frame: each point is moved to the plane through the pixels around it,
/// and flying pixels between two surfaces become NaN. Edges stay; parts narrower than two pixels are lost.
/// \param frame organized.
/// \param seen what the scanner saw, from this frame.
/// \param num_threads 0 = one per core.
/// \return a frame with the same pixels; \p frame itself if it is not organized, has no errors, or if neighboring
/// pixels share their errors, as in stereo and structured light.
pcl::PointCloud<pcl::PointXYZ>::ConstPtr withoutDepthErrors(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& frame,
                                                            const SeenSpace& seen, int num_threads = 0);

}  // namespace pcl_symmetry
