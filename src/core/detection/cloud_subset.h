#pragma once

#include <optional>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The points that stand for a large cloud: as many as the tolerance needs. Planes, decisions and support are theirs;
/// all other points take the support of one near them.
struct CloudSubset {
  std::vector<int> kept;  ///< indices of points of the cloud
  Points points;          ///< 3 x kept.size(), these points
  /// For each point of the cloud the place in kept of a point that is likely to be near.
  std::vector<int> beside;

  /// \param all the points of the cloud.
  /// \param num_threads 0 = one per core.
  /// \return for each point of the cloud the place in kept of a point near it, mostly of the nearest.
  std::vector<int> nearTo(const PointsRef& all, int num_threads) const;
};

/// \param points 3 x N, finite, that hold an answer.
/// \return the points that stand for a cloud; empty where all of its points are needed.
std::optional<CloudSubset> subsetOf(const PointsRef& points, const DetectionOptions& options);

/// Gives each point of a cloud the support of the point that stands for it.
/// \param place_of of each point of the cloud, the place of its support.
void spreadSupport(Detection& detection, const std::vector<int>& place_of);

}  // namespace pcl_symmetry
