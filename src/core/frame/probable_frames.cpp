#include "core/frame/probable_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/frame/canonical_frame.h"
#include "core/frame/frame_fit.h"
#include "core/frame/leveled_frames.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

namespace {

/// The rotation between two frames, the smallest over any order and signs of the axes, radians.
double angleBetween(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  Eigen::Matrix3f rotation = a.transpose() * b;
  if (rotation.determinant() < 0.0f) rotation.col(2) *= -1.0f;
  float trace = -1.0f;
  for (const Eigen::Matrix3i& order : axisRotations())
    trace = std::max(trace, rotation.cwiseProduct(order.cast<float>()).sum());
  return std::acos(std::clamp(0.5 * (static_cast<double>(trace) - 1.0), -1.0, 1.0));
}

bool isKnown(const std::vector<FrameChoice>& known, const FrameCandidate& frame) {
  return std::any_of(known.begin(), known.end(), [&](const FrameChoice& other) {
    return isRotatedAboutRevolution(other.frame.axes, other.revolution_axis, frame.axes) ||
           angleBetween(frame.axes, other.frame.axes) < kFrame.same_frame;
  });
}

std::vector<Eigen::Vector3f> firstAxes(const std::vector<FrameCandidate>& frames) {
  std::vector<Eigen::Vector3f> axes;
  for (const FrameCandidate& frame : frames) {
    if (axes.size() >= kFrame.max_outlines) break;
    const Eigen::Vector3f first = frame.axes.col(0);
    const bool known = std::any_of(axes.begin(), axes.end(), [&](const Eigen::Vector3f& other) {
      return std::abs(other.dot(first)) > std::cos(kFrame.same_outline);
    });
    if (!known) axes.push_back(first);
  }
  return axes;
}

}  // namespace

std::vector<FrameChoice> frameChoices(const FrameEvidence& evidence, const std::vector<FrameCandidate>& frames,
                                      int num_threads) {
  std::vector<FrameCandidate> tried = frames;
  const std::vector<Eigen::Vector3f> axes = firstAxes(frames);
  std::vector<std::vector<FrameCandidate>> leveled(axes.size());
  parallelBlocks(axes.size(), num_threads, [&](std::size_t i) { leveled[i] = leveledFrames(evidence, axes[i]); });
  for (const std::vector<FrameCandidate>& some : leveled) tried.insert(tried.end(), some.begin(), some.end());

  std::vector<FrameChoice> choices;
  double best = -std::numeric_limits<double>::infinity();
  for (const FrameCandidate& frame : tried) {
    if (isKnown(choices, frame)) continue;
    choices.push_back({frame, revolutionAxis(evidence, frame), FrameTerms::Zero()});
    best = std::max(best, frame.value);
  }
  const Eigen::Matrix3f principal = evidence.principal_axes.axes.cast<float>();
  for (FrameChoice& choice : choices) {
    const Outline outline(evidence.points, choice.frame.axes.col(0));
    choice.terms << 1.0, choice.frame.value - best, choice.frame.scores[0],
        outline.boxAt(outline.angleOf(choice.frame.axes.col(1))).contact,
        std::min(angleBetween(choice.frame.axes, principal) / kFrame.far_from_principal, 1.0), 0.0,
        choice.frame.scores[1] + choice.frame.scores[2], 0.0;
  }
  if (!choices.empty()) {
    choices.front().terms[5] = 1.0;
    choices.front().terms[7] = choices.front().frame.scores[0];
  }
  return choices;
}

std::vector<double> frameProbabilities(const std::vector<FrameChoice>& choices, const FrameTerms& weights) {
  double top = 0.0;  // of "none of them"
  for (const FrameChoice& choice : choices) top = std::max(top, weights.dot(choice.terms));
  std::vector<double> probabilities;
  double sum = std::exp(-top);
  for (const FrameChoice& choice : choices) {
    probabilities.push_back(std::exp(weights.dot(choice.terms) - top));
    sum += probabilities.back();
  }
  for (double& p : probabilities) p /= sum;
  return probabilities;
}

FrameTerms frameWeights(bool scanned) {
  return Eigen::Map<const FrameTerms>((scanned ? kFrameFit.scan : kFrameFit.whole).data());
}

}  // namespace pcl_symmetry
