/// Subsets of a cloud, as indices of its points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// \return 0, 1, ..., size - 1.
inline std::vector<int> allOf(Eigen::Index size) {
  std::vector<int> samples(static_cast<std::size_t>(size));
  std::iota(samples.begin(), samples.end(), 0);
  return samples;
}

/// Draws points without replacement.
/// \param size number of points of the cloud.
/// \return num_samples different indices in random order; all indices in order if size <= num_samples.
inline std::vector<int> drawSamples(Eigen::Index size, int num_samples, std::uint64_t seed) {
  std::vector<int> samples = allOf(size);
  if (num_samples >= size) return samples;
  RandomStream random(seed);
  for (int i = 0; i < num_samples; ++i)
    std::swap(samples[i], samples[i + random.below(static_cast<std::uint64_t>(size - i))]);
  samples.resize(num_samples);
  return samples;
}

/// Draws one of each of \p num_drawn equal runs of a sequence.
/// \param size length of the sequence, more than \p num_drawn.
/// \return num_drawn positions in the sequence, rising.
inline std::vector<std::size_t> oneOfEachRun(std::size_t size, std::size_t num_drawn, std::uint64_t seed) {
  std::vector<std::size_t> drawn(num_drawn);
  RandomStream random(seed);
  const double run = static_cast<double>(size) / static_cast<double>(num_drawn);
  std::size_t next = 0;
  for (std::size_t i = 0; i < num_drawn; ++i) {
    const double position = (static_cast<double>(i) + random.uniform()) * run;
    drawn[i] = std::max(next, std::min(size - 1, static_cast<std::size_t>(position)));
    next = drawn[i] + 1;
  }
  return drawn;
}

/// \return 3 x samples.size(), the points with these indices.
inline Points pointsAt(const PointsRef& points, const std::vector<int>& samples) {
  Points chosen(3, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) chosen.col(static_cast<Eigen::Index>(i)) = points.col(samples[i]);
  return chosen;
}

}  // namespace pcl_symmetry
