#pragma once

#include <cstdint>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// A connected piece of the surface that a plane maps onto itself.
struct MatchedRegion {
  std::vector<int> points;  ///< of the samples of MatchedRegions, as indices of points of the cloud, ascending
  double share = 0.0;       ///< of all samples, in [0, 1]
  double support = 0.0;     ///< mean support of its samples, relative to what sampling and noise allow, in [0, 1]
  /// Length of its edge, where the surface goes on without a match, as a share of the edge of a flat disc as large.
  double edge = 0.0;
  std::vector<int> closest;  ///< to the reflection of each sample, as IspStep has it
};

/// Finds the regions that planes map onto themselves. Beyond the paper, whose Figure 8 shows such regions in white.
///
/// Every plane matches some of a surface. A part that is symmetric by itself is matched as far as it goes: its region
/// ends where the part is joined to others, in a short edge, or has no edge at all. What matches by chance, such as a
/// smooth cap about a point of the plane, ends in the middle of the surface, in an edge as long as that of a disc.
class MatchedRegions {
public:
  /// \param cloud,fit must outlive this object.
  MatchedRegions(const NormalizedCloud& cloud, const PlaneFit& fit, std::uint64_t seed, int num_threads);

  /// \param plane normalized frame.
  /// \param guesses MatchedRegion::closest of a plane nearby, which makes the search faster; null = not known.
  /// \return the largest region, empty where nothing matches.
  MatchedRegion largest(const ReflectionPlane& plane, const std::vector<int>* guesses = nullptr) const;

private:
  std::vector<char> inLargest(const std::vector<char>& matched, const IspStep& step,
                              const std::vector<float>& support) const;
  double edgeOf(const std::vector<char>& inside, double count) const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  std::vector<int> samples_;         ///< indices of points of the cloud, ascending
  std::vector<int> neighbors_;       ///< of each sample, as indices of samples, nearest first
  std::vector<int> closest_sample_;  ///< to each point of the cloud, as an index of a sample
};

}  // namespace pcl_symmetry
