#pragma once

#include <optional>
#include <vector>

#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

/// An axis with the turns about it that are symmetries.
struct TurningAxis {
  Line3d line;
  int fold;  ///< 0: every turn
  PlacedGroup group;
};

/// A line with turns about it that are no symmetries.
struct RejectedTurn {
  Line3d line;
  int fold;          ///< 0: turns by any angle
  double angle;      ///< of the turn that fails, radians
  OffShares shares;  ///< of this turn
};

/// Finds the lines about which turns are symmetries, each once.
class AxisFinder {
public:
  /// \param fit,options must outlive this object.
  AxisFinder(const RotationFit& fit, const ObjectSymmetryOptions& options) : fit_(fit), options_(options) {}

  /// Judges lines, the likeliest first. Axes of finite order are dropped once an axis of revolution is found, which
  /// ends the search.
  void judge(const std::vector<Line3d>& lines);

  bool isRound() const { return !axes_.empty() && axes_.front().fold == 0; }
  /// An axis of revolution alone, or axes of finite order, the greatest order first.
  const std::vector<TurningAxis>& axes() const { return axes_; }
  const std::vector<RejectedTurn>& rejected() const { return rejected_; }

private:
  std::optional<TurningAxis> axisAbout(const Line3d& line);
  std::optional<TurningAxis> foldAbout(const Line3d& line, const std::vector<int>& folds) const;

  const RotationFit& fit_;
  const ObjectSymmetryOptions& options_;
  std::vector<Line3d> tried_;
  std::vector<TurningAxis> axes_;
  std::vector<RejectedTurn> rejected_;
};

}  // namespace pcl_symmetry
