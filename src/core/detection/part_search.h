#pragma once

#include <vector>

#include "core/detection/plane_search.h"

namespace pcl_symmetry {

/// A connected piece of the surface that a plane maps onto itself.
struct MatchedRegion {
  std::vector<int> points;  ///< indices of points of the cloud, among the samples of MatchedRegions, ascending
  double share = 0.0;       ///< share of all samples, in [0, 1]
  double support = 0.0;     ///< mean support of its samples, relative to what sampling and noise allow, in [0, 1]
  /// Length of its edge, beyond which the surface continues unmatched, divided by the edge of a flat disc of equal
  /// area.
  double edge = 0.0;
  std::vector<int> closest;  ///< closest point to the reflection of each sample, as in IspStep
};

/// Finds the regions that planes map onto themselves, which Figure 8 shows in white. Not in the paper.
///
/// Every plane matches some part of a surface. A part that is symmetric by itself is matched completely: its region
/// ends with a short edge where the part joins others, or has no edge at all. A chance match, such as a smooth cap
/// about a point of the plane, ends in the middle of the surface, with an edge as long as the edge of a disc.
class MatchedRegions {
public:
  /// \param cloud,fit must outlive this object.
  MatchedRegions(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options);

  /// \param plane normalized frame.
  /// \param guesses MatchedRegion::closest of a plane nearby, which makes the search faster; null = not known.
  /// \param walks finds closest points by walking along neighbor lists, which may miss some.
  /// \return the largest region; empty if nothing matches.
  MatchedRegion largest(const ReflectionPlane& plane, const std::vector<int>* guesses = nullptr,
                        bool walks = false) const;

private:
  std::vector<char> inLargest(const std::vector<char>& matched, const IspStep& step,
                              const std::vector<float>& support) const;
  double edgeOf(const std::vector<char>& inside, double count) const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  std::vector<int> samples_;         ///< indices of points of the cloud, ascending
  std::vector<int> neighbors_;       ///< neighbors of each sample, as indices of samples, nearest first
  std::vector<int> closest_sample_;  ///< closest sample to each point of the cloud, as an index of a sample
};

/// Finds symmetries of parts of a surface, such as planes 2 to 4 of Figure 8.
///
/// Departure from the paper: it takes them from local maxima of the transform of the whole shape, to which a small part
/// contributes too little. Here planes through the middles of balls of several radii, spread over the surface, are
/// refined on the points of their ball and then on the region that they map onto itself (MatchedRegions), which
/// distinguishes a part from a chance match.
///
/// With DetectionOptions::approximate, adds planes of PlaneKind::Local, unlike the symmetries and possible symmetries
/// found before.
void findPlanesOfParts(const PlaneSearch& search, DetectionState& state);

}  // namespace pcl_symmetry
