/// Which points of a cloud take part, by their indices.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

inline std::vector<int> allOf(Eigen::Index size) {
  std::vector<int> samples(static_cast<std::size_t>(size));
  std::iota(samples.begin(), samples.end(), 0);
  return samples;
}

/// Each at most once; all of them where fewer than \p num_samples are there.
inline std::vector<int> drawSamples(Eigen::Index size, int num_samples, std::uint64_t seed) {
  std::vector<int> samples = allOf(size);
  if (num_samples >= size) return samples;
  RandomStream random(seed);
  for (int i = 0; i < num_samples; ++i)
    std::swap(samples[i], samples[i + random.below(static_cast<std::uint64_t>(size - i))]);
  samples.resize(num_samples);
  return samples;
}

inline Points pointsAt(const Points& points, const std::vector<int>& samples) {
  Points chosen(3, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) chosen.col(static_cast<Eigen::Index>(i)) = points.col(samples[i]);
  return chosen;
}

}  // namespace pcl_symmetry
