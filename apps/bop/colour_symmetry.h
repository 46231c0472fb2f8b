/// Which symmetries of a shape also keep its colours.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "bop/surface_colours.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// Difference of colours in CIELAB that counts as none. chosen: half takes uneven light of a scan for print, twice
/// overlooks pale print. 2.3 is just noticeable side by side.
constexpr double kColourTolerance = 12.0;

/// CIELAB of an sRGB colour under D65.
/// \param rgb in [0, 1].
/// \return L in [0, 100], a, b.
Eigen::Vector3f labOf(const Eigen::Vector3f& rgb);

/// Samples of a surface with the colours next to them.
class ColouredSurface {
public:
  /// \param colours at least one.
  /// \param points 3 x N, finite, N >= 1, in the frame of the colours.
  /// \param tolerance difference in CIELAB.
  ColouredSurface(const SurfaceColours& colours, Points points, double tolerance);

  /// Share of the surface on which a motion changes the colour by more than the tolerance.
  double changedShare(const Eigen::Isometry3d& motion) const;

  /// Whether a motion changes the colour of no more than 5 % of the surface.
  bool keeps(const Eigen::Isometry3d& motion) const;

private:
  Points points_;
  Eigen::Matrix3Xf lab_;
  double tolerance_;
  ClosestPointSearch::Ptr search_;
};

/// The greatest group among the symmetries that keeps the colours.
ObjectSymmetries keepingColours(const ObjectSymmetries& found, const ColouredSurface& surface);

}  // namespace pcl_symmetry::apps
