#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

constexpr int kViewRings = 8;      ///< rings of a view in polar coordinates
constexpr int kViewHarmonics = 8;  ///< harmonics of each ring, in addition to its mean
/// Number of values of a view: outline and depth, per ring a mean and the real and imaginary parts of the harmonics.
constexpr int kViewSignatureSize = 2 * kViewRings * (2 * kViewHarmonics + 1);

/// Number of values of a view that do not change with rotations in the image: per ring a mean and the magnitude of each
/// harmonic.
constexpr int kViewMagnitudes = 2 * kViewRings * (kViewHarmonics + 1);

/// The appearance of a shape from far away on one side: its outline and its depths. Not in the paper.
///
/// Signatures need the symmetry of the whole shape, which a scan hides. Views tell which model a scan shows, and from
/// which side.
struct View {
  /// Harmonics of outline and depth on rings around the middle; unit norm, independent of size and distance. Harmonic m
  /// is followed by harmonic m + 1; each holds the real parts of the outline's rings and of the depths' rings, then
  /// the imaginary parts in the same order (harmonic 0 has none). A rotation of the view by an angle a multiplies
  /// harmonic m by exp(-i m a).
  Eigen::VectorXf values;
  double radius = 0.0;  ///< root mean square distance of the inside of the outline from its middle, input units
  /// Transform to the axes of the view: z points away from the viewer, and the origin is the middle of the visible
  /// part.
  Eigen::Isometry3d T_view_input = Eigen::Isometry3d::Identity();
};

/// \param points 3 x N, finite, input units.
/// \param forward direction that the viewer looks in, any length but zero.
/// \throws std::invalid_argument for points that are seen as one, or a direction that is zero.
View viewOf(const PointsRef& points, const Eigen::Vector3d& forward);

/// Views from directions that are spread evenly over the sphere.
/// \param points 3 x N, finite, input units.
/// \param num_views >= 1; with 80, one is within 12 degrees of any direction.
/// \throws std::invalid_argument for points without extent.
std::vector<View> viewsAround(const PointsRef& points, int num_views = 80, int num_threads = 0);

/// Means of the rings and magnitudes of the harmonics, in the order of View::values: the same for all rotations of the
/// view.
/// \return kViewMagnitudes values. Their L2 distance is at most the distance of the signatures at any rotation.
Eigen::VectorXf magnitudesOf(const Eigen::VectorXf& values);

/// How alike two views are at their best rotation.
struct ViewAgreement {
  /// L2 distances of the signatures at the best rotation and of their magnitudesOf(), weighted 0.3 and 0.7, in [0, 2].
  /// Missing parts of a scan change the phases of harmonics more than their magnitudes.
  float distance = 2.0f;
  double angle = 0.0;  ///< rotation about z from the first view to the second, radians
};

/// Compares one view with many, at all rotations in steps of 7.5 degrees.
class ViewComparison {
public:
  explicit ViewComparison(const View& view);

  /// \param enough distance from which the comparison may stop early.
  /// \return a default ViewAgreement if the distance is at least \p enough at all rotations.
  ViewAgreement compare(const float* values, float enough) const;

private:
  Eigen::VectorXf values_, magnitudes_;
};

/// The pose in which a model looks like a scan.
/// \param angle see ViewAgreement::angle.
/// \return T_model_scan.
Eigen::Isometry3d poseOfView(const View& scan, const View& model, double angle);

}  // namespace pcl_symmetry
