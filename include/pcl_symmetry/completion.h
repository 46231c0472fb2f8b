#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

#include "pcl_symmetry/core/symmetric_completion.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A cloud and the points that a symmetry adds to it.
template <typename PointT>
struct CompletedCloud {
  pcl::PointCloud<PointT> cloud;  ///< the input points in their order, then the added points; not organized
  pcl::Indices added;             ///< indices of the added points
  pcl::Indices sources;           ///< for each added point, the index of the point whose reflection it is
};

/// Completes a partial scan by its reflection in a plane of symmetry. A point adds nothing if its reflection falls onto
/// the measured surface or into free space. The position, the normal and the stored viewpoint (vp_x, vp_y, vp_z) of an
/// added point are reflected where its type has them; other fields are copied from its source.
/// \param cloud points that are not finite stay in the cloud and add nothing. Without a finite point nothing is added,
/// and PCL_WARN says so.
/// \param plane plane of symmetry, frame of the cloud.
/// \param viewpoint where the scanner stood; by default it follows from the data, see ScanAnalysis.
/// \throws pcl::BadArgumentException for bad options, and if the points surround the given viewpoint.
template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options = {}, const Viewpoint& viewpoint = {});

/// The same for a cluster of a scene.
/// \param seen what the scanners saw of the scene, frame of the cloud.
template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options, const SeenSpace& seen);

namespace detail {

/// \return the point with its position, normal and stored viewpoint reflected.
template <typename PointT>
PointT reflectPoint(PointT point, const ReflectionPlane& plane) {
  const Eigen::Affine3f reflection = plane.reflection().cast<float>();
  point.getVector3fMap() = plane.reflect(point.getVector3fMap().template cast<double>()).template cast<float>();
  if constexpr (pcl::traits::has_normal<PointT>::value)
    point.getNormalVector3fMap() = (reflection.linear() * point.getNormalVector3fMap()).eval();
  if constexpr (pcl::traits::has_field<PointT, pcl::fields::vp_x>::value) {
    const Eigen::Vector3f seen_from = reflection * Eigen::Vector3f(point.vp_x, point.vp_y, point.vp_z);
    point.vp_x = seen_from.x();
    point.vp_y = seen_from.y();
    point.vp_z = seen_from.z();
  }
  return point;
}

}  // namespace detail

template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options, const Viewpoint& viewpoint) {
  const Points points = detail::selectPoints(cloud, nullptr, cloud.size(), 0).points;
  SeenSpace seen;
  if (points.cols() > 0)
    seen = detail::withBadArguments([&] { return detail::findSeenSpace(cloud, points, viewpoint); });
  return completeBySymmetry(cloud, plane, options, seen);
}

template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options, const SeenSpace& seen) {
  return detail::withBadArguments([&] {
    options.validate();
    CompletedCloud<PointT> completed;
    completed.cloud = cloud;
    completed.cloud.width = static_cast<std::uint32_t>(cloud.size());
    completed.cloud.height = 1;
    const detail::SelectedPoints all = detail::selectPoints(cloud, nullptr, cloud.size(), 0);
    if (all.points.cols() == 0) {
      detail::warnOfNoAnswer("completeBySymmetry", "cloud: no finite point");
      return completed;
    }
    for (const int i : completingPoints(all.points, plane, options, seen.visibility())) {
      completed.sources.push_back(all.indices[i]);
      completed.added.push_back(static_cast<pcl::index_t>(completed.cloud.size()));
      completed.cloud.push_back(detail::reflectPoint(cloud[all.indices[i]], plane));
    }
    return completed;
  });
}

}  // namespace pcl_symmetry
