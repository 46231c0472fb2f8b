#pragma once

#include <pcl/point_types.h>

#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

/// The point with its position, its normal and the viewpoint it carries reflected.
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

template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options, const Viewpoint& viewpoint) {
  return detail::withBadArguments([&] {
    const detail::SelectedPoints all = detail::selectPoints(cloud, nullptr, cloud.size(), 0);
    const std::optional<Visibility> seen =
        all.points.cols() > 0 ? detail::seenSpace(cloud, all.points, viewpoint) : std::optional<Visibility>();
    CompletedCloud<PointT> completed;
    completed.cloud = cloud;
    completed.cloud.width = static_cast<std::uint32_t>(cloud.size());
    completed.cloud.height = 1;
    for (const int i : completingPoints(all.points, plane, options, seen ? &*seen : nullptr)) {
      completed.sources.push_back(all.indices[i]);
      completed.added.push_back(static_cast<pcl::index_t>(completed.cloud.size()));
      completed.cloud.push_back(reflectPoint(cloud[all.indices[i]], plane));
    }
    return completed;
  });
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_completeBySymmetry(T)                                                                  \
  template pcl_symmetry::CompletedCloud<T> pcl_symmetry::completeBySymmetry(                                   \
      const pcl::PointCloud<T>&, const pcl_symmetry::ReflectionPlane&, const pcl_symmetry::CompletionOptions&, \
      const pcl_symmetry::Viewpoint&);
