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
  int source = 0;        ///< index of the scan that was brought to ...
  int target = 0;        ///< ... this one
  double overlap = 0.0;  ///< share of the source's points that lie on the target in the poses of all scans, in [0, 1]
  bool used = false;     ///< whether their own registration agrees with the poses of all scans
};

/// A point of one of several scans.
struct ScanPoint {
  int scan;   ///< index of the scan
  int index;  ///< of the point in it
};

/// Scans of one object in one frame.
struct RegisteredScans {
  std::vector<ScanPose> scans;  ///< one for each scan
  std::vector<ScanPair> pairs;  ///< pairs that converged or are used
  double resolution = 0.0;      ///< input units, distance that the scans resolve: of their points and of their noise
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order

  /// The points of the scans that are kept, thinned where scans overlap: of the points in a cube as wide as the
  /// resolution the one that lies nearest to their mean.
  /// \param scans those that were registered.
  std::vector<ScanPoint> mergedPoints(const std::vector<ObjectScan>& scans) const;
};

/// Brings many scans of one object together, such as those of a turntable, without a guess: pairs of scans are
/// registered to each other (Section 5.1), and poses on which they agree are adjusted together by all surfaces that
/// overlap. Scans that follow each other are tried first, then others, until each scan has three pairs that agree.
///
/// A pair that did not converge alone counts where others agree with it. A pair that contradicts the others is not
/// used, and a scan that fits none is tried with all others together before it is left out. In the end scans of a
/// confidence below 0.5 are left out, the least sure one first.
/// \param scans of one object in the same units; where others than the first cannot be connected with it, those of the
/// largest group are kept.
/// \param options of the registration of pairs, but for its neighborhood.
/// \throws std::invalid_argument for bad options.
RegisteredScans registerAll(const std::vector<ObjectScan>& scans, const CloudRegistrationOptions& options = {});

/// Scans of one object as one cloud.
template <typename PointT>
struct MergedCloud {
  RegisteredScans registration;  ///< poses, and the scans left out
  /// Points of the scans, thinned, in the frame of the first scan that is kept; their normals are rotated with them.
  pcl::PointCloud<PointT> cloud;
  std::vector<int> scans;  ///< of each point of the cloud, the index of its scan
};

/// The scan of a cloud.
/// \param viewpoint where the scanner stood, frame of the cloud; by default the data decide, see ScanAnalysis.
/// \param indices of the points of the scan in the cloud, set.
/// \throws std::invalid_argument where the points surround a viewpoint that was given, pcl::BadArgumentException where
/// that is not finite.
template <typename PointT>
ObjectScan objectScan(const pcl::PointCloud<PointT>& cloud, const Viewpoint& viewpoint, pcl::Indices& indices) {
  detail::checkedViewpoint(viewpoint);
  constexpr std::size_t judged = 10'000;  // points that tell what the scanner saw
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
