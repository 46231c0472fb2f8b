/// Second and third planes of a frame: at all angles about the first axis, then refined as a whole.
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/frame/frame_search.h"

namespace pcl_symmetry {

namespace {

// Steps of the second plane in the half-turn about the first axis. derived: the third plane is a quarter turn ahead.
constexpr std::size_t kNumHalfTurnAngles = 2 * kNumFrameAngles;
// Frames that are refined. chosen: half loses frames that refinement would bring to the front, twice takes twice the
// time.
constexpr std::size_t kMaxRefined = 6;
// Weight of the half-way plane of scans. chosen: at half, bodies of revolution lose their axis; at twice, it outweighs
// the second plane of other shapes.
constexpr double kHalfWayWeight = 0.15;
// Degrees, sizes of the steps of the refinement. derived: the first is less than the 3 degrees between two angles, each
// is half of that before it.
constexpr double kAxesStepsInDegrees[] = {2.0, 1.0, 0.5};
// Steps of one size. chosen: half may end on the way to the maximum, twice costs time where steps go astray.
constexpr int kMaxAxesMoves = 3;

Eigen::Vector3f halfWay(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return (a + b).normalized();
}

bool better(const FrameCandidate& a, const FrameCandidate& b) {
  return a.value > b.value;
}

/// A plane perpendicular to a first one.
struct PerpendicularPlane {
  Eigen::Vector3f normal;
  ScoredOffset best;
  double agreement = 0.0;
  ScoredOffset half_way;  // offset of the plane half-way between it and the first; scans only
};

PerpendicularPlane planeOf(const FrameEvidence& evidence, const CellPlane& first, const Eigen::Vector3f& normal) {
  PerpendicularPlane plane;
  plane.normal = normal;
  plane.best = evidence.bestOffset(plane.normal, evidence.completedAcross(first));
  plane.agreement = evidence.agreement(plane.normal);
  if (evidence.scanned()) plane.half_way = evidence.bestOffset(halfWay(first.normal, plane.normal));
  return plane;
}

PerpendicularPlane planeAt(const FrameEvidence& evidence, const CellPlane& first, std::size_t angle_index) {
  const float angle = static_cast<float>(kPi * static_cast<double>(angle_index) / kNumHalfTurnAngles);
  const Eigen::Vector3f u = first.normal.unitOrthogonal(), v = first.normal.cross(u);
  return planeOf(evidence, first, std::cos(angle) * u + std::sin(angle) * v);
}

FrameCandidate frameOf(const FrameEvidence& evidence, const CellPlane& first, const PerpendicularPlane& second,
                       const PerpendicularPlane& third) {
  FrameCandidate frame;
  frame.axes << first.normal, second.normal, third.normal;
  frame.offsets << first.offset, second.best.offset, third.best.offset;
  frame.scores << evidence.score(first), second.best.score, third.best.score;
  frame.value = evidence.value(frame.scores, evidence.agreement(first.normal) + second.agreement + third.agreement);
  if (evidence.scanned()) {
    frame.turning_axis = second.half_way.score > third.half_way.score ? 2 : 1;
    const ScoredOffset& half_way = frame.turning_axis == 2 ? second.half_way : third.half_way;
    frame.half_way_offset = half_way.offset;
    frame.value += kHalfWayWeight * half_way.score;
  }
  return frame;
}

/// The frame turned to \p axes about the center of mass, with the best offsets near those it had.
FrameCandidate turnedTo(const FrameEvidence& evidence, const FrameCandidate& from, const Eigen::Matrix3f& axes) {
  FrameCandidate frame;
  frame.axes = axes;
  double agreement = 0.0;
  CellPlane first{axes.col(0), 0.0f};
  for (int k = 0; k < 3; ++k) {
    const float before = from.offsets[k] + (axes.col(k) - from.axes.col(k)).dot(evidence.centerOfMass());
    const auto [offset, score] =
        evidence.nearbyOffset(axes.col(k), before, k > 0 ? evidence.completedAcross(first) : nullptr);
    frame.offsets[k] = offset;
    frame.scores[k] = score;
    if (k == 0) first.offset = offset;
    agreement += evidence.agreement(axes.col(k));
  }
  frame.value = evidence.value(frame.scores, agreement);
  if (from.turning_axis > 0) {
    const int other = 3 - from.turning_axis;
    const Eigen::Vector3f normal = halfWay(axes.col(0), axes.col(other));
    const Eigen::Vector3f before = halfWay(from.axes.col(0), from.axes.col(other));
    const ScoredOffset half_way =
        evidence.nearbyOffset(normal, from.half_way_offset + (normal - before).dot(evidence.centerOfMass()));
    frame.turning_axis = from.turning_axis;
    frame.half_way_offset = half_way.offset;
    frame.value += kHalfWayWeight * half_way.score;
  }
  return frame;
}

/// The frame turned about its own axes, by steps of falling size, to the nearest maximum of the value.
FrameCandidate climbed(const FrameEvidence& evidence, const FrameCandidate& start) {
  FrameCandidate frame = turnedTo(evidence, start, start.axes);
  for (const double step : kAxesStepsInDegrees) {
    for (int move = 0; move < kMaxAxesMoves; ++move) {
      FrameCandidate best = frame;
      for (int k = 0; k < 6; ++k) {
        const Eigen::Vector3f about = frame.axes.col(k / 2);
        const Eigen::AngleAxisf turn(static_cast<float>((k % 2 ? -step : step) * kDegree), about);
        const FrameCandidate tried = turnedTo(evidence, frame, turn.toRotationMatrix() * frame.axes);
        if (tried.value > best.value) best = tried;
      }
      if (best.axes == frame.axes) break;
      frame = best;
    }
  }
  return frame;
}

/// The frame whose second axis has the greater score or, where the scores tie, the greater spread of the points.
FrameCandidate ordered(const FrameEvidence& evidence, FrameCandidate frame, double tie) {
  const float ahead = frame.scores[1] - frame.scores[2];
  const bool tied = std::abs(ahead) <= tie;
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

FrameCandidate frameOfAxes(const FrameEvidence& evidence, const Eigen::Matrix3f& axes, double tie) {
  const CellPlane first{axes.col(0), evidence.bestOffset(axes.col(0)).offset};
  return ordered(evidence,
                 frameOf(evidence, first, planeOf(evidence, first, axes.col(1)), planeOf(evidence, first, axes.col(2))),
                 tie);
}

std::vector<FrameCandidate> framesAbout(const FrameEvidence& evidence, const std::vector<CellPlane>& first_planes,
                                        int num_threads) {
  std::vector<PerpendicularPlane> planes(first_planes.size() * kNumHalfTurnAngles);
  parallelBlocks(planes.size(), num_threads, [&](std::size_t i) {
    planes[i] = planeAt(evidence, first_planes[i / kNumHalfTurnAngles], i % kNumHalfTurnAngles);
  });
  std::vector<FrameCandidate> frames;
  for (std::size_t p = 0; p < first_planes.size(); ++p) {
    for (std::size_t angle = 0; angle < kNumFrameAngles; ++angle) {
      const std::size_t second = p * kNumHalfTurnAngles + angle, third = second + kNumFrameAngles;
      frames.push_back(frameOf(evidence, first_planes[p], planes[second], planes[third]));
    }
  }
  return frames;
}

std::vector<FrameCandidate> frameMaxima(const std::vector<FrameCandidate>& turned) {
  std::vector<FrameCandidate> maxima;
  for (std::size_t first = 0; first < turned.size(); first += kNumFrameAngles) {
    const auto value = [&](std::size_t angle) { return turned[first + angle % kNumFrameAngles].value; };
    for (std::size_t angle = 0; angle < kNumFrameAngles; ++angle)
      if (value(angle) >= value(angle + kNumFrameAngles - 1) && value(angle) > value(angle + 1))
        maxima.push_back(turned[first + angle]);
    // Where no angle stands out, any is right.
    if (maxima.empty()) maxima.push_back(turned[first]);
  }
  std::stable_sort(maxima.begin(), maxima.end(), better);
  maxima.resize(std::min(maxima.size(), kMaxRefined));
  return maxima;
}

std::vector<FrameCandidate> refinedFrames(const FrameEvidence& evidence, std::vector<FrameCandidate> frames, double tie,
                                          int num_threads) {
  parallelBlocks(frames.size(), num_threads,
                 [&](std::size_t i) { frames[i] = ordered(evidence, climbed(evidence, frames[i]), tie); });
  std::stable_sort(frames.begin(), frames.end(), better);
  return frames;
}

}  // namespace pcl_symmetry
