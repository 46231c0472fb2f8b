#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

/// A search in a moved and scaled frame.
/// \param search over points.
/// \return the same search over (points - center) / scale.
ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale);

/// A search among some of the points of another one.
/// \param search over all points.
/// \param num_points of all.
/// \param kept indices of different points; the result counts in these.
ClosestPointSearch::Ptr among(ClosestPointSearch::Ptr search, std::size_t num_points, const std::vector<int>& kept);

}  // namespace pcl_symmetry
