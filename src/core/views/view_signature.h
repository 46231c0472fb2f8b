#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

constexpr int kViewRings = 8;      ///< of a picture in polar coordinates
constexpr int kViewHarmonics = 8;  ///< of each ring, beside its mean
/// Values of a view: of the outline and of the depths, per ring, a mean, and real and imaginary parts.
constexpr int kViewSignatureSize = 2 * kViewRings * (2 * kViewHarmonics + 1);

/// What a shape looks like from far away on one side: which model a scan shows is told by its outline and its depths,
/// where the symmetry of the whole, which signatures are made of, is hidden.
struct View {
  /// Of unit norm, the same for every size and distance: harmonic m is followed by harmonic m + 1, each with the
  /// outline's rings, then those of the depths, real parts first. A turn of the picture by an angle a multiplies
  /// harmonic m by exp(-i m a).
  Eigen::VectorXf values;
  double radius = 0.0;  ///< root mean square distance of the inside of the outline from its middle, input units
  /// To the axes of the picture, of which z points away from the viewer; the middle of what is seen is the origin.
  Eigen::Isometry3d T_view_input = Eigen::Isometry3d::Identity();
};

/// \param points 3 x N, finite, input units. \param forward where the viewer looks, any length but zero.
/// \throws std::invalid_argument for points without extent across \p forward or a direction that is zero.
View viewOf(const PointsRef& points, const Eigen::Vector3d& forward);

/// The views from directions spread evenly over the sphere.
/// \param num_views >= 1: of 80, the nearest is within 12 degrees of any direction.
/// \throws std::invalid_argument for points without extent.
std::vector<View> viewsAround(const PointsRef& points, int num_views = 80, int num_threads = 0);

/// How alike two views are, and how the one has to be turned.
struct ViewAgreement {
  float distance = 2.0f;  ///< L2 distance of the signatures at the best turn, in [0, 2]
  double turn = 0.0;      ///< radians about z, of the first view's picture to the second's
};

/// Compares one view with many, at all turns of the picture in steps of 7.5 degrees.
class ViewComparison {
public:
  /// \param view of a scan.
  explicit ViewComparison(const View& view);

  /// \param values kViewSignatureSize, of another view. \param enough a distance from which on nothing is looked for.
  /// \return the default where all turns are as far as \p enough.
  ViewAgreement compare(const float* values, float enough) const;

private:
  Eigen::VectorXf values_;
};

/// The pose that a view of a model has if a view of a scan at the given turn is the same.
Eigen::Isometry3d poseOfView(const View& scan, const View& model, double turn);

}  // namespace pcl_symmetry
