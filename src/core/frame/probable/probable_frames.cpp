#include "core/frame/probable/probable_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/frame/canonical_frame.h"
#include "core/frame/probable/frame_fit.h"
#include "core/frame/probable/outline.h"
#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {

namespace {

// Radians, frames closer than this are one. derived: a frame within 5 degrees of the right one is right.
constexpr double kOneFrame = 5.0 * kDegree;
// Radians, first axes that differ by less have one outline. chosen: half tries nearly the same frames twice, twice
// leaves out the second of two planes.
constexpr double kOneOutline = 10.0 * kDegree;
// First axes whose outline is tried. measured: on 150 models of fold 0 the two best lead to the own axes of 86 % of the
// wholes; more were not tried.
constexpr std::size_t kMaxOutlines = 2;
// Radians, steps of the angle about the first axis, within a quarter turn. chosen: half takes twice the time, twice
// leaves frames 1 degree beside the edge that they stand on.
constexpr double kOutlineStep = 1.0 * kDegree;
// Radians, angle to the principal axes at which the term ends. chosen: half ends it where slender shapes still differ,
// twice lets square shapes count.
constexpr double kFarFromPrincipal = 20.0 * kDegree;

/// The rotation between two frames, the smallest over any order and signs of the axes, radians.
double angleBetween(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  Eigen::Matrix3f turn = a.transpose() * b;
  if (turn.determinant() < 0.0f) turn.col(2) *= -1.0f;
  float trace = -1.0f;
  for (const Eigen::Matrix3i& order : axisRotations())
    trace = std::max(trace, turn.cwiseProduct(order.cast<float>()).sum());
  return std::acos(std::clamp(0.5 * (static_cast<double>(trace) - 1.0), -1.0, 1.0));
}

bool isKnown(const std::vector<FrameChoice>& known, const FrameCandidate& frame) {
  return std::any_of(known.begin(), known.end(), [&](const FrameChoice& other) {
    if (other.revolution_axis == 3) return true;
    if (other.revolution_axis >= 0) {
      const Eigen::Vector3f axis = other.frame.axes.col(other.revolution_axis);
      if ((frame.axes.transpose() * axis).cwiseAbs().maxCoeff() > std::cos(kOneFrame)) return true;
    }
    return angleBetween(frame.axes, other.frame.axes) < kOneFrame;
  });
}

/// The angles about an axis at which people may have put a shape.
std::vector<double> anglesOf(const FrameEvidence& evidence, const Outline& outline) {
  double least_area = std::numeric_limits<double>::infinity(), contact = -1.0, agreement = -1.0;
  double smallest = 0.0, longest = 0.0, most_faces = 0.0;
  const int num_steps = static_cast<int>(std::lround(0.5 * kPi / kOutlineStep));
  for (int i = 0; i < num_steps; ++i) {
    const double angle = i * kOutlineStep;
    const Outline::Box box = outline.boxAt(angle);
    const double faces =
        evidence.agreement(outline.direction(angle)) + evidence.agreement(outline.direction(angle + 0.5 * kPi));
    if (box.area < least_area) {
      least_area = box.area;
      smallest = angle;
    }
    if (box.contact > contact) {
      contact = box.contact;
      longest = angle;
    }
    if (faces > agreement) {
      agreement = faces;
      most_faces = angle;
    }
  }
  // The principal axes of the outline: half the angle of the second moments.
  const auto spread = [&](double angle) { return evidence.spreadAlong(outline.direction(angle)); };
  const double principal = 0.5 * std::atan2(spread(0.25 * kPi) - spread(0.75 * kPi), spread(0.0) - spread(0.5 * kPi));
  return {smallest, longest, most_faces, principal};
}

/// The frame with its first axis at each of the angles.
std::vector<FrameCandidate> framesOnOutline(const FrameEvidence& evidence, const Eigen::Vector3f& first) {
  const Outline outline(evidence.points(), first);
  std::vector<FrameCandidate> frames;
  for (const double angle : anglesOf(evidence, outline)) {
    Eigen::Matrix3f axes;
    axes << first, outline.direction(angle), first.cross(outline.direction(angle));
    frames.push_back(frameOfAxes(evidence, axes));
  }
  return frames;
}

std::vector<Eigen::Vector3f> firstAxes(const std::vector<FrameCandidate>& frames) {
  std::vector<Eigen::Vector3f> axes;
  for (const FrameCandidate& frame : frames) {
    if (axes.size() >= kMaxOutlines) break;
    const Eigen::Vector3f first = frame.axes.col(0);
    const bool known = std::any_of(axes.begin(), axes.end(), [&](const Eigen::Vector3f& other) {
      return std::abs(other.dot(first)) > std::cos(kOneOutline);
    });
    if (!known) axes.push_back(first);
  }
  return axes;
}

}  // namespace

std::vector<FrameChoice> frameChoices(const FrameEvidence& evidence, const std::vector<FrameCandidate>& frames,
                                      double tie, int num_threads) {
  std::vector<FrameCandidate> tried = frames;
  const std::vector<Eigen::Vector3f> axes = firstAxes(frames);
  std::vector<std::vector<FrameCandidate>> turned(axes.size());
  parallelBlocks(axes.size(), num_threads, [&](std::size_t i) { turned[i] = framesOnOutline(evidence, axes[i]); });
  for (const std::vector<FrameCandidate>& some : turned) tried.insert(tried.end(), some.begin(), some.end());

  std::vector<FrameChoice> choices;
  double best = -std::numeric_limits<double>::infinity();
  for (const FrameCandidate& frame : tried) {
    if (isKnown(choices, frame)) continue;
    choices.push_back({frame, revolutionAxis(evidence, frame, tie), FrameTerms::Zero()});
    best = std::max(best, frame.value);
  }
  const Eigen::Matrix3f principal = evidence.principalAxes().axes.cast<float>();
  for (FrameChoice& h : choices) {
    const Outline outline(evidence.points(), h.frame.axes.col(0));
    h.terms << 1.0, h.frame.value - best, h.frame.scores[0],
        outline.boxAt(outline.angleOf(h.frame.axes.col(1))).contact,
        std::min(angleBetween(h.frame.axes, principal) / kFarFromPrincipal, 1.0), 0.0;
  }
  if (!choices.empty()) choices.front().terms[5] = 1.0;
  return choices;
}

std::vector<double> frameProbabilities(const std::vector<FrameChoice>& choices, const FrameTerms& weights) {
  double top = 0.0;  // of "none of them"
  for (const FrameChoice& h : choices) top = std::max(top, weights.dot(h.terms));
  std::vector<double> probabilities;
  double sum = std::exp(-top);
  for (const FrameChoice& h : choices) {
    probabilities.push_back(std::exp(weights.dot(h.terms) - top));
    sum += probabilities.back();
  }
  for (double& p : probabilities) p /= sum;
  return probabilities;
}

FrameTerms frameWeights(bool scanned) {
  return Eigen::Map<const FrameTerms>((scanned ? kFrameFit.scan : kFrameFit.whole).data());
}

}  // namespace pcl_symmetry
