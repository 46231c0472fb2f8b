#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The points that represent a large cloud, as many as the tolerance requires. They determine planes, decisions and
/// support; every other point takes the support of the nearest of them.
/// \param points 3 x N, finite, for which whyUnanswerable() is empty.
/// \return indices of points; nothing if all points are needed.
std::optional<std::vector<int>> drawSubset(const PointsRef& points, const DetectionOptions& options);

/// Gives each point of a cloud the support of the point that represents it.
/// \param representative_of for each point, the index of the point whose support it takes; -1: it supports nothing.
void spreadSupport(Detection& detection, const std::vector<int>& representative_of);

/// Thins a cloud until opposite sides are about equally dense.
///
/// Where noise hides the surface, planes are judged by the point density, so a cloud that is sparser on one side looks
/// as asymmetric as a shape that ends there. The logarithm of the density is fitted by a linear function of the
/// position. Variation of the shape itself is equal on both sides of a symmetry plane and remains.
/// \return indices in increasing order; all if the density is even.
std::vector<int> thinToEvenDensity(const NormalizedCloud& cloud, std::uint64_t seed);

}  // namespace pcl_symmetry
