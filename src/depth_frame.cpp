#include <pcl/common/point_tests.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/base/median.h"
#include "core/scan/depth_filter.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();  // the depth of a pixel without a point
// Radius of the filter in pixels. Of 2 and 3, the one that leaves the least errors on the objects of five scenes; 1
// leaves a third of the noise.
constexpr int kRadius = 2;

/// Angle between the rays of neighboring pixels; 0 where there are none.
double pixelAngle(const Cloud& frame, const Eigen::Vector3d& viewpoint) {
  std::vector<double> angles;
  const auto ray = [&](std::size_t i) -> Eigen::Vector3d {
    return (frame[i].getVector3fMap().cast<double>() - viewpoint).normalized();
  };
  for (std::size_t i = 0; i + 1 < frame.size(); ++i) {
    if ((i + 1) % frame.width == 0 || !pcl::isXYZFinite(frame[i]) || !pcl::isXYZFinite(frame[i + 1])) continue;
    angles.push_back(ray(i).cross(ray(i + 1)).norm());
  }
  return angles.empty() ? 0.0 : median(std::move(angles));
}

}  // namespace

Cloud::ConstPtr withoutDepthErrors(const Cloud::ConstPtr& frame, const SeenSpace& seen, int num_threads) {
  const Visibility* visibility = seen.visibility();
  if (!frame || seen.source() != ViewpointSource::Rays || visibility->width() != static_cast<int>(frame->width) ||
      visibility->height() != static_cast<int>(frame->height))
    return frame;
  const Eigen::Vector3d viewpoint = visibility->viewpoint();
  DepthImage image{visibility->width(), visibility->height(), std::vector<float>(frame->size(), kNone),
                   pixelAngle(*frame, viewpoint)};
  for (std::size_t i = 0; i < frame->size(); ++i)
    if (pcl::isXYZFinite((*frame)[i]))
      image.depths[i] = visibility->depth(static_cast<int>(i % frame->width), static_cast<int>(i / frame->width));
  const FilteredDepths filtered = filterDepths(image, kRadius, num_threads);
  if (!(filtered.inverse_error > 0.0)) return frame;
  auto result = pcl::make_shared<Cloud>(*frame);
  for (std::size_t i = 0; i < result->size(); ++i) {
    const double factor = static_cast<double>(filtered.depths[i]) / image.depths[i];
    const Eigen::Vector3d point = viewpoint + factor * ((*frame)[i].getVector3fMap().cast<double>() - viewpoint);
    (*result)[i].getVector3fMap() = point.cast<float>();
  }
  result->is_dense = false;
  return result;
}

namespace detail {

DepthFrame depthFrame(const ScannerOutput& scanned, int num_threads) {
  std::optional<Visibility> seen = seenByOrganizedCloud(scanned.pixels, scanned.width, scanned.height);
  if (!seen) return {};
  DepthFrame frame{nullptr, {std::move(*seen), ViewpointSource::Rays}};
  const Cloud::ConstPtr cloud = cloudOf(scanned), filtered = withoutDepthErrors(cloud, frame.seen, num_threads);
  if (filtered != cloud) frame = {filtered, SeenSpace(*filtered)};
  return frame;
}

}  // namespace detail

}  // namespace pcl_symmetry
