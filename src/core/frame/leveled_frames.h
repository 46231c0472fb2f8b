#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/frame_search.h"

namespace pcl_symmetry {

/// The convex outline of points seen along an axis: how people may have put the shape. Not in the paper. Where no
/// second plane is a symmetry, people level what the shape stands on.
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
    double contact = 0.0;  ///< longest stretch of a side that the shape touches, as a share of the longer side
  };
  Box boxAt(double angle) const;

private:
  Eigen::Vector3f u_, v_;
  std::vector<Eigen::Vector2f> corners_;  // of the outline, in order
};

/// Frames rotated about their first axis to the smallest box around the outline, to its longest contact, to the faces
/// of the surface, and to the principal axes of the outline.
/// \param first unit, the first axis.
std::vector<FrameCandidate> leveledFrames(const FrameEvidence& evidence, const Eigen::Vector3f& first);

/// Puts the best frame, rotated to the faces of the surface, before all others where its value is nearly as great and
/// the shape then stands on more of its outline.
/// \param frames best first, at least one.
std::vector<FrameCandidate> leveledFirst(const FrameEvidence& evidence, std::vector<FrameCandidate> frames);

}  // namespace pcl_symmetry
