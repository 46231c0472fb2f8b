/// The paper's own way to a canonical frame (Section 5.1), with the parts that its text allows.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry::apps {

struct PublishedFrame {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;  ///< columns, orthonormal, right-handed, in the order in which they were found
};

struct PublishedFrameOptions {
  /// Whether maxima are refined by Iterative Symmetric Points (Section 4.4), within the planes perpendicular to those
  /// found before. Maxima that leave their cell stay, because so the method does best.
  bool refined = true;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0: one per core
};

/// Each axis is the normal of the plane of greatest symmetry among those that are left; the center is where the three
/// planes meet. The map is exact, by convolution over 64 x 64 x 64 planes (Section 4.2). What a scanner saw is not
/// used, and nothing breaks ties.
/// \param points 3 x N, finite, with extent.
PublishedFrame publishedFrame(const Points& points, const PublishedFrameOptions& options);

}  // namespace pcl_symmetry::apps
