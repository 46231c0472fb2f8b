/// The synthetic shapes as PCL clouds.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <limits>

#include "shapes/shapes.h"

namespace pcl_symmetry::test {

template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr toCloud(const Shape& shape) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  cloud->resize(shape.points.cols());
  for (Eigen::Index i = 0; i < shape.points.cols(); ++i)
    (*cloud)[i].getVector3fMap() = shape.points.col(i).cast<float>();
  return cloud;
}

/// Puts a point that is not finite before every \p stride-th point.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr withHoles(const pcl::PointCloud<PointT>& cloud, std::size_t stride) {
  auto result = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % stride == 0) {
      PointT hole = cloud[i];
      hole.y = i % (2 * stride) ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
      result->push_back(hole);
    }
    result->push_back(cloud[i]);
  }
  result->is_dense = false;
  return result;
}

}  // namespace pcl_symmetry::test
