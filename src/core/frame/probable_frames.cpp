#include "core/frame/probable_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/frame/canonical_frame.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

namespace {

/// Twice the area of a triangle, positive if its corners are in counterclockwise order.
float signedArea(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Andrew's monotone chain (1979).
std::vector<Eigen::Vector2f> convexHull(std::vector<Eigen::Vector2f> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2f> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2f& point : points) {
      while (hull.size() >= first + 2 && signedArea(hull[hull.size() - 2], hull.back(), point) <= 0.0f) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The angle within 90 degrees at which a measure is greatest.
double angleOfGreatest(const std::function<double(double)>& measure) {
  const double step = kFrame.outline_step;
  const int num_steps = static_cast<int>(std::lround(0.5 * kPi / step));
  double greatest = -std::numeric_limits<double>::infinity(), at = 0.0;
  for (int i = 0; i < num_steps; ++i) {
    const double value = measure(i * step);
    if (value <= greatest) continue;
    greatest = value;
    at = i * step;
  }
  return at;
}

double angleOfFaces(const FrameEvidence& evidence, const Outline& outline) {
  return angleOfGreatest([&](double angle) {
    return evidence.agreement(outline.direction(angle)) + evidence.agreement(outline.direction(angle + 0.5 * kPi));
  });
}

/// The angle of the principal axes of the outline: half the angle of the second moments.
double angleOfPrincipalAxes(const FrameEvidence& evidence, const Outline& outline) {
  const auto spread = [&](double angle) { return evidence.spreadAlong(outline.direction(angle)); };
  return 0.5 * std::atan2(spread(0.25 * kPi) - spread(0.75 * kPi), spread(0.0) - spread(0.5 * kPi));
}

FrameCandidate frameAt(const FrameEvidence& evidence, const Outline& outline, const Eigen::Vector3f& first,
                       double angle) {
  Eigen::Matrix3f axes;
  axes << first, outline.direction(angle), first.cross(outline.direction(angle));
  return frameOfAxes(evidence, axes);
}

double contactOf(const Outline& outline, const FrameCandidate& frame) {
  return outline.boxAt(outline.angleOf(frame.axes.col(1))).contact;
}

/// Frames rotated about their first axis to the smallest box around the outline, to its longest contact, to the faces
/// of the surface, and to the principal axes of the outline.
/// \param first unit, the first axis.
std::vector<FrameCandidate> leveledFrames(const FrameEvidence& evidence, const Eigen::Vector3f& first) {
  const Outline outline(evidence.points, first);
  std::vector<FrameCandidate> frames;
  for (const double angle : {angleOfGreatest([&](double a) { return -outline.boxAt(a).area; }),
                             angleOfGreatest([&](double a) { return outline.boxAt(a).contact; }),
                             angleOfFaces(evidence, outline), angleOfPrincipalAxes(evidence, outline)})
    frames.push_back(frameAt(evidence, outline, first, angle));
  return frames;
}

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
    if (!isNearAny(axes, first, std::cos(kFrame.same_outline))) axes.push_back(first);
  }
  return axes;
}

}  // namespace

Outline::Outline(const PointsRef& points, const Eigen::Vector3f& along)
    : u_(along.unitOrthogonal()), v_(along.cross(u_)) {
  std::vector<Eigen::Vector2f> seen;
  seen.reserve(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) seen.emplace_back(u_.dot(points.col(i)), v_.dot(points.col(i)));
  corners_ = convexHull(std::move(seen));
}

Eigen::Vector3f Outline::direction(double angle) const {
  return static_cast<float>(std::cos(angle)) * u_ + static_cast<float>(std::sin(angle)) * v_;
}

double Outline::angleOf(const Eigen::Vector3f& vector) const {
  return std::atan2(v_.dot(vector), u_.dot(vector));
}

Outline::Box Outline::boxAt(double angle) const {
  if (corners_.empty()) return {};
  const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  Eigen::Matrix2f sides;
  sides << c, s, -s, c;
  Eigen::AlignedBox2f around;
  for (const Eigen::Vector2f& corner : corners_) around.extend(Eigen::Vector2f(sides * corner));
  const float longer = around.sizes().maxCoeff(), touch = static_cast<float>(kFrame.touch) * longer;
  Box box;
  box.area = static_cast<double>(around.sizes()[0]) * around.sizes()[1];
  if (!(longer > 0.0f)) return box;
  for (int k = 0; k < 2; ++k) {
    Eigen::AlignedBox2f low, high;  // around the corners that touch either side
    for (const Eigen::Vector2f& corner : corners_) {
      const Eigen::Vector2f x = sides * corner;
      if (x[k] <= around.min()[k] + touch) low.extend(x);
      if (x[k] >= around.max()[k] - touch) high.extend(x);
    }
    box.contact = std::max<double>(box.contact, std::max(low.sizes()[1 - k], high.sizes()[1 - k]) / longer);
  }
  return box;
}

std::vector<FrameCandidate> leveledFirst(const FrameEvidence& evidence, std::vector<FrameCandidate> frames) {
  const FrameCandidate& best = frames.front();
  const Eigen::Vector3f first = best.axes.col(0);
  const Outline outline(evidence.points, first);
  const FrameCandidate leveled = frameAt(evidence, outline, first, angleOfFaces(evidence, outline));
  if (leveled.value >= best.value - kFrame.max_lost_value &&
      contactOf(outline, leveled) >= contactOf(outline, best) + kFrame.min_gained_contact)
    frames.insert(frames.begin(), leveled);
  return frames;
}

std::vector<FrameChoice> frameChoices(const FrameEvidence& evidence, const std::vector<FrameCandidate>& frames,
                                      int num_threads) {
  std::vector<FrameCandidate> tried = frames;
  const std::vector<Eigen::Vector3f> axes = firstAxes(frames);
  std::vector<std::vector<FrameCandidate>> leveled(axes.size());
  parallelBlocks(axes.size(), num_threads, [&](std::size_t i) { leveled[i] = leveledFrames(evidence, axes[i]); });
  for (const std::vector<FrameCandidate>& some : leveled) tried.insert(tried.end(), some.begin(), some.end());

  std::vector<FrameChoice> choices;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const FrameCandidate& frame = tried[i];
    if (isKnown(choices, frame)) continue;
    choices.push_back(
        {frame, revolutionAxis(evidence, frame), FrameTerms::Zero(), i < frames.size() ? static_cast<int>(i) : -1});
    best = std::max(best, frame.value);
  }
  const Eigen::Matrix3f principal = evidence.principal_axes.axes.cast<float>();
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  std::optional<Outline> outline;  // outline seen along the first axis, which leveled frames share
  for (FrameChoice& choice : choices) {
    if (choice.frame.axes.col(0) != first) outline.emplace(evidence.points, first = choice.frame.axes.col(0));
    choice.terms << 1.0, choice.frame.value - best, choice.frame.scores[0], contactOf(*outline, choice.frame),
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
  double top = 0.0;  // log odds of "none of them"
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

}  // namespace pcl_symmetry
