#pragma once

#include <optional>
#include <vector>

#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

/// A line with rotations about it that are no symmetries, in the normalized frame.
struct RejectedAxis {
  Line3d line;
  int fold;          ///< order of the rotations; 0 = by any angle
  double angle;      ///< angle of the rotation that fails, radians
  OffShares shares;  ///< shares of that rotation
};

/// The principal axes of the points through their center of mass and, if points are unevenly dense, through the center
/// of the bounding ball, and the line through both centers. The axis of a shape of revolution is one of them, and so is
/// the axis of a fold of 3 or more if it is the only one.
std::vector<Line3d> principalLines(const RotationFit& fit);

/// Lines through these centers, in all directions, about which a rotation of prime order overlaps most with the
/// surface.
/// \param num_directions number of lines through each center, on a half sphere.
std::vector<Line3d> axisLineCandidates(const RotationFit& fit, int num_directions, int max_fold, int num_threads);

/// The half turn about an axis perpendicular to a line that overlaps most with the surface.
/// \param width range of the angles of the axes, [0, width), radians; it is divided into \p num_angles.
/// \param offsets positions of the axis along the line, from its origin.
Line3d bestAcross(const RotationFit& fit, const Line3d& line, double width, int num_angles,
                  const std::vector<double>& offsets);

/// Finds the lines about which rotations are symmetries, each once.
class AxisFinder {
public:
  /// \param fit,options must outlive this object.
  AxisFinder(const RotationFit& fit, const ObjectSymmetryOptions& options) : fit_(fit), options_(options) {}

  /// Judges lines, the likeliest first. Axes of finite order are dropped once an axis of revolution is found, which
  /// ends the search.
  void judge(const std::vector<Line3d>& lines);

  bool isRound() const { return !axes_.empty() && axes_.front().fold == 0; }
  /// An axis of revolution alone, or axes of finite order, the greatest order first.
  const std::vector<PlacedGroup>& axes() const { return axes_; }
  const std::vector<RejectedAxis>& rejected() const { return rejected_; }

private:
  std::optional<PlacedGroup> axisAbout(const Line3d& line);
  std::optional<PlacedGroup> foldAbout(const RotationFit& fit, const Line3d& line, const std::vector<int>& folds) const;

  const RotationFit& fit_;
  const ObjectSymmetryOptions& options_;
  std::vector<Line3d> tried_;
  std::vector<PlacedGroup> axes_;
  std::vector<RejectedAxis> rejected_;
};

/// The greatest group that contains the axes and that the surface supports as a whole.
/// \return C_1 if there is no axis.
PlacedGroup greatestGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                          const std::vector<PlacedGroup>& axes);

}  // namespace pcl_symmetry
