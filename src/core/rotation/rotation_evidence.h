#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/refinement/normalized_cloud.h"
#include "core/rotation/rotation_rules.h"
#include "core/scan/range_image.h"
#include "pcl_symmetry/core/plane_types.h"

namespace pcl_symmetry {

/// The least margin to a limit, >= 0 if all are kept. It serves to compare the orders of a line, and different lines;
/// rotationConfidence(), which is reported, is fitted to lines chosen this way.
/// \param rotation with the shares that were seen.
inline double marginOf(const SymmetryRotation& rotation) {
  const double min_on = rotation.fold == 0   ? kScanAxes.round_on
                        : rotation.fold == 2 ? kScanAxes.twofold_on
                                             : kScanAxes.fold_on;
  const double max_off = rotation.fold == 0 ? kScanAxes.max_round_off : kScanAxes.max_off,
               max_far = rotation.fold == 0 ? kScanAxes.max_round_far : kScanAxes.max_far;
  const double margin =
      std::min({1.0 - rotation.off / max_off, 1.0 - rotation.far / max_far, rotation.support / min_on - 1.0});
  return rotation.fold == 0 ? margin
                            : std::min(margin, (rotation.halfway - rotation.off) / kScanAxes.halfway_more - 1.0);
}

/// Shares of the visible points by where a rotation about a line maps them; the rest is mapped into occluded space.
struct RotationShares {
  double on = 0.0;   ///< share mapped to within the tolerance of the visible surface
  double off = 0.0;  ///< share mapped into free space, beyond the tolerance
  double far = 0.0;  ///< share mapped into free space, beyond ten tolerances: a handle, not a dent
};

/// Judges rotations by the visible surface and the free space in front of it. Not in the paper.
class RotationEvidence {
public:
  /// \param cloud a scan; must outlive this object.
  /// \param tolerance normalized frame.
  RotationEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed);

  /// Screens a rotation by distances from the EDT at a few points.
  /// \param max_off,max_far shares above which the remaining points are skipped.
  RotationShares screen(const Eigen::Affine3d& motion, double max_off, double max_far) const;

  /// Measures a rotation by distances from the surface.
  RotationShares measure(const Eigen::Affine3d& motion) const;

  /// \param line axis of a nearly round body.
  /// \return indices into samples_ of the points that some rotation about the line maps far into free space, such as a
  /// handle; only some of them if they are more than kScanAxes.max_off_body.
  std::vector<int> samplesOffBody(const Line3d& line) const;

  /// \param some indices into samples_, at least one.
  /// \return share of these points that a motion maps onto the surface.
  double shareOn(const Eigen::Affine3d& motion, const std::vector<int>& some) const;

  /// How strongly the matches of a rotation constrain its line: the second smallest eigenvalue of the point-to-plane
  /// stiffness under two tilts and two translations; mean over the points, radii. The smallest eigenvalue is small for
  /// all surfaces that slide.
  double stiffness(const Line3d& line, double angle) const;

  /// The line, moved to where some rotations about it best map the visible points onto each other: point to plane, with
  /// weights that fall with the distance and the angle between the normals. A side that faces away from the scanner has
  /// no matches. Matches at borders do not count, because the true match may be hidden, unless the point is mapped into
  /// free space: then the border pulls it back.
  Line3d refineLine(const Line3d& line, const std::vector<double>& angles) const;

  /// The same from a nearly correct line, with more points and narrower weights.
  Line3d refineLineClosely(const Line3d& line, const std::vector<double>& angles) const;

  const NormalizedCloud& cloud() const { return cloud_; }

private:
  /// Normal equations of a small motion of a line: two tilts and two translations.
  struct LineEquations {
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  };

  Points moved(const Eigen::Affine3d& motion, const std::vector<int>& samples) const;
  /// \param farthest greatest distance from the surface that is measured.
  Landing landMoved(Points images, double farthest) const;
  /// \param width width of the weights, tolerances.
  /// \param[in,out] closest closest points to the moved samples, for a line nearby; -1 = not known.
  void addEquations(const IspSurface& surface, const Line3d& line, double angle, const std::vector<int>& samples,
                    double width, std::vector<int>& closest, LineEquations& equations) const;
  Line3d fitLine(const IspSurface& surface, const Line3d& start, const std::vector<double>& angles,
                 const std::vector<int>& samples, const ScanAxisRules::Widths& widths) const;
  /// The rim of the visible surface is as exact as its pixels.
  bool isFree(const Eigen::Vector3d& x) const {
    return isFreeSpace(*cloud_.visibility, x, tolerance_, std::max(tolerance_, cloud_.spacing));
  }

  const NormalizedCloud& cloud_;
  double tolerance_;
  double far_, greatest_disc_;  ///< distance from which points are far, and radius of the greatest disc of a point
  std::vector<int> samples_, few_samples_;
  Points facing_;  ///< normals, oriented toward the scanner
};

/// Evidence for a twofold rotation of a scan besides the shares of SymmetryRotation: such a rotation maps most points
/// into occluded space, and a flat side that is mapped onto itself is weak evidence.
struct HalfTurnEvidence {
  double extent_ratio = 1.0;  ///< extent of points and images together, divided by that of the points; >= 1
  double stiffness = 1.0;     ///< RotationEvidence::stiffness()
  /// Minimum over pairs of perpendicular planes through the line of the greater share of points that either plane
  /// reflects into free space: most objects with a twofold axis have such planes.
  double planes_off_share = 0.0;
  /// 1 if another rotation of the scan fits better and the two lines do not cross at a right angle, as twofold axes of
  /// prisms do.
  double conflicts_with_best = 0.0;
};

/// A rotation that was judged, whatever its confidence.
struct JudgedRotation {
  SymmetryRotation rotation;  ///< input frame
  HalfTurnEvidence half_turns;
};

/// \param rotations rotations of one scan, input frame, with their shares of visible points.
/// \param min_confidence planes are not searched if the other evidence gives a rotation less, see rotationConfidence().
/// \return one entry per rotation; only twofold rotations have other values than the defaults.
std::vector<HalfTurnEvidence> halfTurnEvidence(const RotationEvidence& evidence,
                                               const std::vector<SymmetryRotation>& rotations,
                                               double min_confidence = 0.0, int num_threads = 1);

/// Kinds of rotations with their own coefficients: a twofold one hides most of its evidence.
enum class RotationKind { AnyAngle, Half, Folds };

RotationKind kindOf(const SymmetryRotation& rotation);

/// Terms of the log odds that rotations of a scan are symmetries of the whole object; the first is 1. Their
/// coefficients are fitted by test/benchmark/fit_rotations.py.
/// \param rotation rotation with its shares of visible points.
std::vector<double> rotationOddsTerms(const SymmetryRotation& rotation, const HalfTurnEvidence& half_turns);

/// Probability that the rotations map at least 90 % of the whole surface to within 1 % of the diameter of the surface,
/// and all but 1.25 % to within ten times that.
/// \param rotation rotation with its shares of visible points.
double rotationConfidence(const SymmetryRotation& rotation, const HalfTurnEvidence& half_turns);

}  // namespace pcl_symmetry
