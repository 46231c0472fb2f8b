#pragma once

#include <string>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Fewer distinct points hold no symmetry that could be told from chance.
constexpr int kMinDistinctPoints = 20;

/// Why points hold no answer: too few distinct ones, all at one position, or all on one line (a line is symmetric in
/// every plane that contains it, whatever it was sampled from).
///
/// Positions are compared up to the rounding of the coordinates; a line may be 1e-6 of its length thick.
/// \param points 3 x N, N >= 0, finite.
/// \return one sentence such as "12 distinct points, at least 20 are needed"; empty where the points can be analyzed.
/// \throws std::invalid_argument where a coordinate is not finite.
std::string whyUnanswerable(const PointsRef& points);

}  // namespace pcl_symmetry
