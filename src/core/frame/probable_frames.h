#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/frame_search.h"

namespace pcl_symmetry {

/// The convex outline of points seen along an axis: if no second plane is a symmetry, people level the shape by the
/// side that it stands on. Not in the paper.
class Outline {
public:
  /// \param points 3 x N, N >= 1.
  /// \param along unit, the axis that the points are seen along.
  Outline(const PointsRef& points, const Eigen::Vector3f& along);

  /// \return the unit vector perpendicular to the axis at an angle, radians.
  Eigen::Vector3f direction(double angle) const;
  /// \return the angle of a vector projected along the axis.
  double angleOf(const Eigen::Vector3f& vector) const;

  /// The box around the outline with sides at an angle and 90 degrees ahead.
  struct Box {
    double area = 0.0;     ///< input units squared
    double contact = 0.0;  ///< longest part of a side that the shape touches, divided by the longer side
  };
  Box boxAt(double angle) const;

private:
  Eigen::Vector3f u_, v_;
  std::vector<Eigen::Vector2f> corners_;  // corners of the outline, in order
};

/// Puts the best frame, rotated to the faces of the surface, first if its value is nearly as great and the shape then
/// stands on more of its outline.
/// \param frames best first, at least one.
std::vector<FrameCandidate> leveledFirst(const FrameEvidence& evidence, std::vector<FrameCandidate> frames);

/// The probability of each of several frames to be the shape's own. Not in the paper.
///
/// A frame is right if its axes, in any order and with any sign, are within 5 degrees of those that people gave the
/// shape; a frame with an axis of revolution may be rotated about it by any angle. The probability of a frame is
/// exp(w.x) / (1 + the sum of exp(w.x) over all frames of the shape), a conditional logit whose 1 represents "none
/// of them" (McFadden 1974). test/benchmark/fit_frames.py fits the weights w.

/// The evidence for a frame: x above.
///   0  1
///   1  value, less the value of the best frame of the shape, <= 0
///   2  score of the first plane
///   3  Outline::Box::contact, seen along the first axis
///   4  angle to the principal axes of the points, in any order and sign, as a share of 20 degrees, at most 1
///   5  1 for the frame that the search put first
///   6  sum of the scores of the second and third plane
///   7  score of the first plane for the frame that the search put first, else 0
using FrameTerms = Eigen::Matrix<double, 8, 1>;

/// A frame that may be the shape's own.
struct FrameChoice {
  FrameCandidate frame;
  int revolution_axis = -1;  ///< as in SymmetryFrame
  FrameTerms terms = FrameTerms::Zero();
  int found_as = -1;  ///< index among the frames of the search; -1 = a leveled frame
};

/// The frames of a search, each once up to order, signs and rotations about an axis of revolution, and frames rotated
/// about their first axes: to the smallest box around the outline, to its longest contact, to the faces, and to the
/// principal axes of the outline.
/// \param frames from refinedFrames(), best first.
/// \return the best frame first; the frames of the search before all others.
std::vector<FrameChoice> frameChoices(const FrameEvidence& evidence, const std::vector<FrameCandidate>& frames,
                                      int num_threads);

/// \return one probability per frame; their sum is less than 1.
std::vector<double> frameProbabilities(const std::vector<FrameChoice>& choices, const FrameTerms& weights);

}  // namespace pcl_symmetry
