#include "core/segmentation/merging/fragments.h"

#include <algorithm>
#include <limits>

namespace pcl_symmetry {

namespace {

/// The region with the patch that is closest to any patch of a region; -1 if there is no other region.
int closestRegion(const Regions& regions, const PartEvidence& evidence, int region) {
  const std::vector<int>& of = regions.ofPatches();
  int closest = -1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t p = 0; p < of.size(); ++p) {
    if (of[p] != region) continue;
    for (std::size_t q = 0; q < of.size(); ++q) {
      const float sq_distance = (evidence.patches.centers.col(p) - evidence.patches.centers.col(q)).squaredNorm();
      if (of[q] == region || sq_distance >= least) continue;
      closest = of[q];
      least = sq_distance;
    }
  }
  return closest;
}

/// The neighbour with the most contact, or the closest region if there is none; -1 if there is no other region.
int hostOf(const Regions& regions, const PartEvidence& evidence, int fragment) {
  int host = -1;
  double most = -1.0;
  for (const int other : regions.neighbours(fragment)) {
    const double contact = regions.cues(fragment, other)[kContact];
    if (contact > most) {
      host = other;
      most = contact;
    }
  }
  return host >= 0 ? host : closestRegion(regions, evidence, fragment);
}

int smallestRegion(const Regions& regions) {
  int smallest = -1;
  for (int r = 0; r < regions.size(); ++r)
    if (regions.exists(r) && (smallest < 0 || regions.area(r) < regions.area(smallest))) smallest = r;
  return smallest;
}

}  // namespace

Regions joinFragments(Regions regions, const PartEvidence& evidence, double least_area) {
  for (;;) {
    const int smallest = smallestRegion(regions);
    if (regions.area(smallest) >= least_area) return regions;
    const int host = hostOf(regions, evidence, smallest);
    if (host < 0) return regions;
    regions.merge(host, smallest);
  }
}

LabelledRegions joinEmptiedRegions(LabelledRegions labelled, const SurfaceGraph& graph, const PartEvidence& evidence,
                                   double least_area) {
  auto& [regions, labels] = labelled;
  std::vector<double> areas(static_cast<std::size_t>(regions.size()), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[labels[i]] += graph.areas[i];
  for (int r = 0; r < regions.size(); ++r) {
    if (!regions.exists(r) || areas[r] >= least_area) continue;
    const int host = hostOf(regions, evidence, r);
    if (host < 0) continue;
    regions.merge(host, r);
    areas[host] += areas[r];
    std::replace(labels.begin(), labels.end(), r, host);
  }
  return labelled;
}

}  // namespace pcl_symmetry
