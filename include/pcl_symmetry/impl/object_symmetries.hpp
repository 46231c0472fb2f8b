#pragma once

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/object_symmetries.h"

namespace pcl_symmetry {

template <typename PointT>
ObjectSymmetries detectObjectSymmetries(const pcl::PointCloud<PointT>& cloud, const ObjectSymmetryOptions& options) {
  return detail::withBadArguments([&] {
    return objectSymmetries(detail::selectPoints(cloud, nullptr, cloud.size(), options.seed).points, options);
  });
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_detectObjectSymmetries(T)                               \
  template pcl_symmetry::ObjectSymmetries pcl_symmetry::detectObjectSymmetries( \
      const pcl::PointCloud<T>&, const pcl_symmetry::ObjectSymmetryOptions&);
