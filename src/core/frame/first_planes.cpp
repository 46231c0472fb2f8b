/// Candidates for the first plane of a frame.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/frame/frame_search.h"
#include "pcl_symmetry/core/local_maxima.h"

namespace pcl_symmetry {

namespace {

// Radians, maxima of the map with closer normals share one basin. measured: on 120 scans of 60 models of the Princeton
// Shape Benchmark no first plane was missed with 9 degrees and 24 candidates; the 30 best maxima alone share one basin.
constexpr double kCandidateAngle = 9.0 * kDegree;
constexpr std::size_t kMaxCandidates = 24;  // maxima of the map. measured: see above
// Faces of the surface. derived: three directions of a box, and as many of a second part that stands askew.
constexpr int kMaxPeaks = 6;
// Planes that are completed to frames. chosen: half loses frames whose first plane is not the best by itself, twice
// takes twice the time.
constexpr std::size_t kMaxFirstPlanes = 6;
// Degrees, sizes of the steps to a maximum. derived: the first is a bin of the map (2.8 degrees), each is half of that
// before it.
constexpr double kPlaneStepsInDegrees[] = {3.0, 1.5, 0.75};
// Steps of one size. derived: 4 of 3 degrees reach past the basin of a candidate, 9 degrees.
constexpr int kMaxPlaneMoves = 4;

bool isKnown(const std::vector<CellPlane>& planes, const Eigen::Vector3f& normal, double angle) {
  return std::any_of(planes.begin(), planes.end(),
                     [&](const CellPlane& other) { return std::abs(other.normal.dot(normal)) > std::cos(angle); });
}

/// The plane moved to the nearest maximum of quality, by steps of falling size. It turns about the center of mass.
CellPlane climbed(const FrameEvidence& evidence, CellPlane plane) {
  double quality = evidence.quality(plane);
  for (const double step : kPlaneStepsInDegrees) {
    for (int move = 0; move < kMaxPlaneMoves; ++move) {
      const Eigen::Vector3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
      CellPlane better = plane;
      for (const Eigen::Vector3f& side : {u, Eigen::Vector3f(-u), v, Eigen::Vector3f(-v)}) {
        const Eigen::Vector3f normal =
            (plane.normal + static_cast<float>(std::tan(step * kDegree)) * side).normalized();
        const auto [offset, score] =
            evidence.nearbyOffset(normal, plane.offset + (normal - plane.normal).dot(evidence.centerOfMass()));
        const double tried = score + evidence.agreement(normal);
        if (tried <= quality) continue;
        quality = tried;
        better = {normal, offset};
      }
      if (better.normal == plane.normal) break;
      plane = better;
    }
  }
  return plane;
}

}  // namespace

std::vector<CellPlane> firstPlaneCandidates(const FrameEvidence& evidence, const SymmetryMap& map, int num_threads) {
  LocalMaximaOptions maxima;
  maxima.num_threads = num_threads;
  std::vector<CellPlane> candidates;
  for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
    if (candidates.size() >= kMaxCandidates) break;
    const CellPlane plane = evidence.toCells(maximum.plane);
    if (!isKnown(candidates, plane.normal, kCandidateAngle)) candidates.push_back(plane);
  }
  const std::size_t num_maxima = candidates.size();
  for (int k = 0; k < 3; ++k) candidates.push_back({evidence.principalAxes().axes.col(k).cast<float>(), 0.0f});
  for (const Eigen::Vector3f& peak : evidence.directions().peaks(kMaxPeaks)) candidates.push_back({peak, 0.0f});
  parallelBlocks(candidates.size(), num_threads, [&](std::size_t i) {
    CellPlane& plane = candidates[i];
    if (i >= num_maxima) plane.offset = evidence.bestOffset(plane.normal).offset;
    plane = climbed(evidence, plane);
  });
  return candidates;
}

std::vector<CellPlane> bestFirstPlanes(const FrameEvidence& evidence, const std::vector<CellPlane>& candidates) {
  std::vector<std::pair<double, CellPlane>> ranked;
  for (const CellPlane& plane : candidates) ranked.emplace_back(evidence.quality(plane), plane);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<CellPlane> best;
  for (const auto& [quality, plane] : ranked) {
    if (best.size() >= kMaxFirstPlanes) break;
    if (!isKnown(best, plane.normal, 0.5 * kCandidateAngle)) best.push_back(plane);
  }
  return best;
}

}  // namespace pcl_symmetry
