#include "core/frame/frame_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

namespace {

bool isKnown(const std::vector<CellPlane>& planes, const Eigen::Vector3f& normal, double angle) {
  return isNearAny(planes, normal, std::cos(angle), &CellPlane::normal);
}

/// Moves a plane to the nearest maximum of quality, by decreasing steps, degrees. It rotates about the center of mass.
CellPlane climb(const FrameEvidence& evidence, CellPlane plane) {
  double quality = evidence.quality(plane);
  for (const double step : {3.0, 1.5, 0.75}) {
    for (int move = 0; move < kFrame.max_plane_moves; ++move) {
      const Eigen::Vector3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
      CellPlane better = plane;
      for (const Eigen::Vector3f& side : {u, Eigen::Vector3f(-u), v, Eigen::Vector3f(-v)}) {
        const Eigen::Vector3f normal =
            (plane.normal + static_cast<float>(std::tan(step * kDegree)) * side).normalized();
        const auto [offset, score] =
            evidence.nearbyOffset(normal, plane.offset + (normal - plane.normal).dot(evidence.center_of_mass));
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

Eigen::Vector3f halfWay(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return (a + b).normalized();
}

/// A plane perpendicular to a first one.
struct PerpendicularPlane {
  Eigen::Vector3f normal;
  ScoredOffset best;
  double agreement = 0.0;
  ScoredOffset half_way;  // offset of the plane half-way between this plane and the first; scans only
};

PerpendicularPlane planeOf(const FrameEvidence& evidence, const CellPlane& first, const Eigen::Vector3f& normal) {
  PerpendicularPlane plane;
  plane.normal = normal;
  plane.best = evidence.bestOffset(plane.normal, evidence.completedAcross(first));
  plane.agreement = evidence.agreement(plane.normal);
  if (evidence.scanned) plane.half_way = evidence.bestOffset(halfWay(first.normal, plane.normal));
  return plane;
}

/// \param angle_index in steps of 90 degrees / num_angles.
PerpendicularPlane planeAt(const FrameEvidence& evidence, const CellPlane& first, std::size_t angle_index) {
  const float angle = static_cast<float>(kPi * static_cast<double>(angle_index) / (2 * kFrame.num_angles));
  return planeOf(evidence, first, directionAcross(first.normal, angle));
}

FrameCandidate frameOf(const FrameEvidence& evidence, const CellPlane& first, const PerpendicularPlane& second,
                       const PerpendicularPlane& third) {
  FrameCandidate frame;
  frame.axes << first.normal, second.normal, third.normal;
  frame.offsets << first.offset, second.best.offset, third.best.offset;
  frame.scores << evidence.score(first), second.best.score, third.best.score;
  frame.value = evidence.value(frame.scores, evidence.agreement(first.normal) + second.agreement + third.agreement);
  if (evidence.scanned) {
    frame.rotation_axis = second.half_way.score > third.half_way.score ? 2 : 1;
    const ScoredOffset& half_way = frame.rotation_axis == 2 ? second.half_way : third.half_way;
    frame.half_way_offset = half_way.offset;
    frame.value += kFrame.half_way_weight * half_way.score;
  }
  return frame;
}

/// The frame rotated to \p axes about the center of mass, with the best offsets near those before.
FrameCandidate rotatedTo(const FrameEvidence& evidence, const FrameCandidate& from, const Eigen::Matrix3f& axes) {
  FrameCandidate frame;
  frame.axes = axes;
  double agreement = 0.0;
  CellPlane first{axes.col(0), 0.0f};
  for (int k = 0; k < 3; ++k) {
    const float before = from.offsets[k] + (axes.col(k) - from.axes.col(k)).dot(evidence.center_of_mass);
    const auto [offset, score] =
        evidence.nearbyOffset(axes.col(k), before, k > 0 ? evidence.completedAcross(first) : nullptr);
    frame.offsets[k] = offset;
    frame.scores[k] = score;
    if (k == 0) first.offset = offset;
    agreement += evidence.agreement(axes.col(k));
  }
  frame.value = evidence.value(frame.scores, agreement);
  if (from.rotation_axis > 0) {
    const int other = 3 - from.rotation_axis;
    const Eigen::Vector3f normal = halfWay(axes.col(0), axes.col(other));
    const Eigen::Vector3f before = halfWay(from.axes.col(0), from.axes.col(other));
    const ScoredOffset half_way =
        evidence.nearbyOffset(normal, from.half_way_offset + (normal - before).dot(evidence.center_of_mass));
    frame.rotation_axis = from.rotation_axis;
    frame.half_way_offset = half_way.offset;
    frame.value += kFrame.half_way_weight * half_way.score;
  }
  return frame;
}

/// Rotates a frame about its own axes, by decreasing steps, to the nearest maximum of the value.
FrameCandidate climb(const FrameEvidence& evidence, const FrameCandidate& start) {
  FrameCandidate frame = rotatedTo(evidence, start, start.axes);
  for (const double step : {2.0, 1.0, 0.5}) {
    for (int move = 0; move < kFrame.max_frame_moves; ++move) {
      FrameCandidate best = frame;
      for (int k = 0; k < 6; ++k) {
        const Eigen::Vector3f about = frame.axes.col(k / 2);
        const Eigen::AngleAxisf rotation(static_cast<float>((k % 2 ? -step : step) * kDegree), about);
        const FrameCandidate tried = rotatedTo(evidence, frame, rotation.toRotationMatrix() * frame.axes);
        if (tried.value > best.value) best = tried;
      }
      if (best.axes == frame.axes) break;
      frame = best;
    }
  }
  return frame;
}

/// The frame whose second axis has the greater score or, where the scores tie, the greater spread of the points.
FrameCandidate ordered(const FrameEvidence& evidence, FrameCandidate frame) {
  const float ahead = frame.scores[1] - frame.scores[2];
  const bool tied = std::abs(ahead) <= kFrame.tie;
  const bool swapped =
      tied ? evidence.spreadAlong(frame.axes.col(2)) > evidence.spreadAlong(frame.axes.col(1)) : ahead < 0.0f;
  if (swapped) {
    frame.axes.col(1).swap(frame.axes.col(2));
    std::swap(frame.offsets[1], frame.offsets[2]);
    std::swap(frame.scores[1], frame.scores[2]);
  }
  return frame;
}

}  // namespace

std::vector<CellPlane> firstPlaneCandidates(const FrameEvidence& evidence, const SymmetryMap& map, int num_threads) {
  std::vector<CellPlane> candidates;
  for (const LocalMaximum& maximum : findLocalMaxima(map, {}, num_threads)) {
    if (candidates.size() >= kFrame.max_candidates) break;
    const CellPlane plane = evidence.toCells(maximum.plane);
    if (!isKnown(candidates, plane.normal, kFrame.candidate_angle)) candidates.push_back(plane);
  }
  const std::size_t num_maxima = candidates.size();
  for (int k = 0; k < 3; ++k) candidates.push_back({evidence.principal_axes.axes.col(k).cast<float>(), 0.0f});
  for (const Eigen::Vector3f& peak : evidence.directions.peaks(kFrame.max_faces)) candidates.push_back({peak, 0.0f});
  parallelBlocks(candidates.size(), num_threads, [&](std::size_t i) {
    CellPlane& plane = candidates[i];
    if (i >= num_maxima) plane.offset = evidence.bestOffset(plane.normal).offset;
    plane = climb(evidence, plane);
  });
  return candidates;
}

std::vector<CellPlane> bestFirstPlanes(const FrameEvidence& evidence, const std::vector<CellPlane>& candidates) {
  std::vector<std::pair<double, CellPlane>> ranked;
  for (const CellPlane& plane : candidates) ranked.emplace_back(evidence.quality(plane), plane);
  sortDescending(ranked, [](const auto& entry) { return entry.first; });
  std::vector<CellPlane> best;
  for (const auto& [quality, plane] : ranked) {
    if (best.size() >= kFrame.max_first_planes) break;
    if (!isKnown(best, plane.normal, 0.5 * kFrame.candidate_angle)) best.push_back(plane);
  }
  return best;
}

FrameCandidate frameOfAxes(const FrameEvidence& evidence, const Eigen::Matrix3f& axes) {
  const CellPlane first{axes.col(0), evidence.bestOffset(axes.col(0)).offset};
  return ordered(
      evidence, frameOf(evidence, first, planeOf(evidence, first, axes.col(1)), planeOf(evidence, first, axes.col(2))));
}

std::vector<FrameCandidate> framesAbout(const FrameEvidence& evidence, const std::vector<CellPlane>& first_planes,
                                        int num_threads) {
  // The second plane lies within 90 degrees, the third one within the following 90 degrees.
  const std::size_t num_angles = kFrame.num_angles, num_planes = 2 * num_angles;
  std::vector<PerpendicularPlane> planes(first_planes.size() * num_planes);
  parallelBlocks(planes.size(), num_threads,
                 [&](std::size_t i) { planes[i] = planeAt(evidence, first_planes[i / num_planes], i % num_planes); });
  std::vector<FrameCandidate> frames;
  for (std::size_t p = 0; p < first_planes.size(); ++p) {
    for (std::size_t angle = 0; angle < num_angles; ++angle) {
      const std::size_t second = p * num_planes + angle, third = second + num_angles;
      frames.push_back(frameOf(evidence, first_planes[p], planes[second], planes[third]));
    }
  }
  return frames;
}

std::vector<FrameCandidate> frameMaxima(const std::vector<FrameCandidate>& rotated) {
  const std::size_t num_angles = kFrame.num_angles;
  std::vector<FrameCandidate> maxima;
  for (std::size_t first = 0; first < rotated.size(); first += num_angles) {
    const auto value = [&](std::size_t angle) { return rotated[first + angle % num_angles].value; };
    for (std::size_t angle = 0; angle < num_angles; ++angle)
      if (value(angle) >= value(angle + num_angles - 1) && value(angle) > value(angle + 1))
        maxima.push_back(rotated[first + angle]);
    // Where no angle stands out, all are equally good.
    if (maxima.empty()) maxima.push_back(rotated[first]);
  }
  sortDescending(maxima, &FrameCandidate::value);
  maxima.resize(std::min(maxima.size(), kFrame.max_refined));
  return maxima;
}

std::vector<FrameCandidate> refinedFrames(const FrameEvidence& evidence, std::vector<FrameCandidate> frames,
                                          int num_threads) {
  parallelBlocks(frames.size(), num_threads,
                 [&](std::size_t i) { frames[i] = ordered(evidence, climb(evidence, frames[i])); });
  sortDescending(frames, &FrameCandidate::value);
  return frames;
}

}  // namespace pcl_symmetry
