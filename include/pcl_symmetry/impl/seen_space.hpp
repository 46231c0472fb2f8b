#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/point_cloud.h>

#include <optional>
#include <stdexcept>

#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/impl/point_selection.hpp"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// The rays of an organized cloud from a pinhole camera; nothing where its rows and columns are not such a picture.
/// \param pixels 3 x (width * height), row by row, NaN where there is no point.
std::optional<Visibility> seenByOrganizedCloud(const Points& pixels, int width, int height);

/// Seen, free and unknown space of a cloud.
/// \param points the points of it that are analysed. \return nothing where there is no viewpoint.
/// \throws std::invalid_argument where the points surround the viewpoint given.
template <typename PointT>
std::optional<Visibility> seenSpace(const pcl::PointCloud<PointT>& cloud, const Points& points,
                                    const Viewpoint& viewpoint) {
  if (viewpoint.mode == Viewpoint::Mode::None) return std::nullopt;
  if (viewpoint.mode == Viewpoint::Mode::Given) {
    std::optional<Visibility> seen = Visibility::fromPoints(points, viewpoint.position);
    if (!seen)
      throw std::invalid_argument("viewpoint: among the points, must see them within 75 degrees of one direction");
    return seen;
  }
  if (cloud.isOrganized() && cloud.width > 1) {
    Points pixels(3, static_cast<Eigen::Index>(cloud.size()));
    for (std::size_t i = 0; i < cloud.size(); ++i)
      pixels.col(static_cast<Eigen::Index>(i)) =
          pcl::isXYZFinite(cloud[i])
              ? Eigen::Vector3f(cloud[i].getVector3fMap())
              : Eigen::Vector3f(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    if (auto seen = seenByOrganizedCloud(pixels, static_cast<int>(cloud.width), static_cast<int>(cloud.height)))
      return seen;
  }
  return spaceSeenFrom(points, cloud.sensor_origin_.template head<3>().template cast<double>());
}

}  // namespace pcl_symmetry
