#pragma once

#include <cstdint>
#include <vector>

#include "core/detection/normalized_cloud.h"

namespace pcl_symmetry {

/// Points of a cloud such that they lie about equally dense on one side and on the other.
///
/// Where noise leaves no surface, density is what planes are judged by, and a cloud that is thinner on one side is no
/// more symmetric than a shape that ends there. The logarithm of the density is fitted by a linear function of the
/// place: what the shape itself varies by is the same on both sides of a symmetry, and stays.
/// \return indices in increasing order; all where the density is even.
std::vector<int> evenlyDense(const NormalizedCloud& cloud, std::uint64_t seed);

}  // namespace pcl_symmetry
