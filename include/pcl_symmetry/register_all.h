#pragma once

#include <pcl/point_cloud.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_registration.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// One of several scans of an object.
struct ObjectScan {
  Points points = Points(3, 0);    ///< 3 x N, finite, input units
  std::optional<Visibility> seen;  ///< what the scanner saw, frame of the points; nothing = the object from all sides
};

/// The pose of a scan.
struct ScanPose {
  /// From the frame of this scan to that of the first scan that is kept; the identity where this one is left out.
  Eigen::Isometry3d T_first_scan = Eigen::Isometry3d::Identity();
  /// Estimated probability that the scan fits the others there, in [0, 1], by their points and by the free space of
  /// each scanner. Another pose may fit as well if the object looks alike from several sides.
  double confidence = 0.0;
  std::string left_out;  ///< why the scan is left out, one sentence; empty where it is kept
};

/// Two scans that were registered to each other.
struct ScanPair {
  int source = 0;        ///< index of the scan that was registered
  int target = 0;        ///< index of the scan that it was registered to
  double overlap = 0.0;  ///< share of the source's points that lie on the target in the poses of all scans, in [0, 1]
  bool used = false;     ///< whether the registration of this pair agrees with the poses of all scans
};

/// A point of one of several scans.
struct ScanPoint {
  int scan;   ///< index of the scan
  int index;  ///< index of the point in that scan
};

/// Scans of one object in one frame.
struct RegisteredScans {
  std::vector<ScanPose> scans;  ///< one for each scan
  std::vector<ScanPair> pairs;  ///< pairs that converged or that are used
  double resolution = 0.0;      ///< distance that the scans resolve, from their spacing and noise, input units
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds

  /// The points of the scans that are kept, thinned where scans overlap: each cube with an edge of `resolution` keeps
  /// the point nearest to the mean of its points.
  /// \param scans the scans that were registered.
  std::vector<ScanPoint> mergedPoints(const std::vector<ObjectScan>& scans) const;
};

/// Aligns many scans of one object, such as those of a turntable, without an initial guess: pairs of scans are
/// registered to each other (Section 5.1), and poses on which they agree are adjusted together by all surfaces that
/// overlap. Scans that follow each other are tried first, then others, until each scan has three pairs that agree.
///
/// A pair that did not converge alone counts if others agree with it. A pair that contradicts the others is not used,
/// and a scan that fits none is tried with all others together before it is left out. In the end, scans with a
/// confidence below 0.5 are left out, the least certain first.
/// \param scans scans of one object in the same units; if some cannot be connected with the others, the largest
/// connected group is kept.
/// \param options options of the registration of pairs; `around` is not used.
/// \throws std::invalid_argument for bad options.
RegisteredScans registerAll(const std::vector<ObjectScan>& scans, const CloudRegistrationOptions& options = {});

/// Scans of one object as one cloud.
template <typename PointT>
struct MergedCloud {
  RegisteredScans registration;  ///< poses, and the scans left out
  /// Points of the scans, thinned, in the frame of the first scan that is kept; their normals are rotated with them.
  pcl::PointCloud<PointT> cloud;
  std::vector<int> scans;  ///< for each point of the cloud, the index of its scan
};

/// Selects the points of a cloud that form its scan.
/// \param viewpoint where the scanner stood, frame of the cloud; by default it follows from the data, see ScanAnalysis.
/// \param indices filled with the indices of the points of the scan in the cloud.
/// \throws std::invalid_argument if the points surround a given viewpoint, pcl::BadArgumentException if that is not
/// finite.
template <typename PointT>
ObjectScan objectScan(const pcl::PointCloud<PointT>& cloud, const Viewpoint& viewpoint, pcl::Indices& indices) {
  detail::checkedViewpoint(viewpoint);
  constexpr std::size_t judged = 10'000;  // points that show what the scanner saw
  detail::SelectedPoints all = detail::selectPoints(cloud, nullptr, cloud.size(), 0);
  ObjectScan scan{std::move(all.points), std::nullopt};
  indices = std::move(all.indices);
  const Points few = detail::selectPoints(cloud, nullptr, judged, 1).points;
  if (few.cols() > 0) scan.seen = detail::visibilityOf(detail::findSeenSpace(cloud, few, viewpoint));
  return scan;
}

/// registerAll() for clouds. Points that are not finite are left out.
/// \param viewpoint where the scanner stood, in the frame of each cloud.
/// \throws pcl::BadArgumentException for bad options, and where the points surround a viewpoint that was given.
template <typename PointT>
MergedCloud<PointT> mergeScans(const std::vector<typename pcl::PointCloud<PointT>::ConstPtr>& clouds,
                               const CloudRegistrationOptions& options = {}, const Viewpoint& viewpoint = {}) {
  return detail::withBadArguments([&] {
    std::vector<ObjectScan> scans;
    std::vector<pcl::Indices> indices(clouds.size());
    for (std::size_t k = 0; k < clouds.size(); ++k) scans.push_back(objectScan(*clouds[k], viewpoint, indices[k]));
    MergedCloud<PointT> merged{registerAll(scans, options), {}, {}};
    for (const ScanPoint& from : merged.registration.mergedPoints(scans)) {
      const Eigen::Isometry3f motion = merged.registration.scans[from.scan].T_first_scan.template cast<float>();
      PointT point = (*clouds[from.scan])[indices[from.scan][from.index]];
      point.getVector3fMap() = (motion * scans[from.scan].points.col(from.index)).eval();
      if constexpr (pcl::traits::has_normal<PointT>::value)
        point.getNormalVector3fMap() = (motion.linear() * point.getNormalVector3fMap()).eval();
      merged.cloud.push_back(point);
      merged.scans.push_back(from.scan);
    }
    return merged;
  });
}

}  // namespace pcl_symmetry
