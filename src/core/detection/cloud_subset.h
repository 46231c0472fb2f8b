#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The points that represent a large cloud: as many as the tolerance needs. Planes, decisions and support are theirs;
/// all other points take the support of the nearest one.
/// \param points 3 x N, finite, that hold an answer.
/// \return indices of points; empty where all of them are needed.
std::optional<std::vector<int>> subsetOf(const PointsRef& points, const DetectionOptions& options);

/// Gives each point of a cloud the support of the point that represents it.
/// \param representative_of for each point, the index of the point whose support it takes; -1: it supports nothing.
void spreadSupport(Detection& detection, const std::vector<int>& representative_of);

/// Thins a cloud so that its points are about equally dense on opposite sides.
///
/// Where noise leaves no surface, planes are judged by the density, and a cloud that is thinner on one side is no more
/// symmetric than a shape that ends there. The logarithm of the density is fitted by a linear function of the position.
/// Variation of the shape itself is the same on both sides of a symmetry, and stays.
/// \return indices in increasing order; all where the density is even.
std::vector<int> evenlyDense(const NormalizedCloud& cloud, std::uint64_t seed);

}  // namespace pcl_symmetry
