#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/constants.h"
#include "core/refinement/normalized_cloud.h"
#include "core/scan/range_image.h"
#include "pcl_symmetry/core/plane_types.h"

namespace pcl_symmetry {

/// Parameters of the axes of scans. Unless stated otherwise, lengths are in radii of the cloud and angles in radians.
struct ScanAxisRules {
  int normal_samples = 600, normal_draws = 60,
      normals_in_draw = 8;               ///< samples, draws, and normals per draw, for lines of bodies of revolution
  int from_normals = 3;                  ///< greatest number of such lines that are kept
  double angle_of_fold = 3.0 * kDegree;  ///< error of the angles between planes of scans, radians
  double min_plane_angle = 0.13;         ///< least angle between two planes that give a common line
  /// Coarse axial transform: cells along an edge of its distance field, bins of the directions and offsets, samples.
  int coarse_cells = 24, coarse_theta = 8, coarse_phi = 32, coarse_offset = 8, coarse_samples = 32;
  /// Greatest distance of an axis from the middle of the cloud in the coarse axial transform.
  double coarse_reach = 0.67;
  std::size_t coarse_maxima = 10;  ///< greatest number of maxima of the coarse axial transform
  double coarsely_same = 0.3;      ///< radians and radii within which two of these maxima are one
  double coarse_equal = 0.05;      ///< greatest deficit of D to the peak for an order that may be the axis'
  int max_order = 12;              ///< greatest order: bodies of more folds look nearly round in a scan
  int round_rotations = 10;        ///< rotations that represent rotations by any angle, in addition to small ones
  double small_angle = 0.26, larger_angle = 0.7;  ///< angles that the fit of a round body uses
  /// Factor on max_off and max_far, and greatest distance in tolerances, in screening.
  double rough_factor = 3.0, rough_slack = 2.0;
  std::size_t max_planes_of_axes = 8;  ///< greatest number of planes whose common lines are tried
  double plane_share = 0.85;           ///< least share of these planes
  /// Limits within which two axes are one: no body has two nearer ones.
  double same_axis_angle = 0.12, same_axis_offset = 0.1;
  double fitted_same = 0.02;  ///< radians and radii within which lines are judged only once
  std::size_t max_axes = 5;   ///< greatest number of axes; a polyhedron seen from a corner shows as many
  int scored_planes = 4;      ///< planes over which D of a round body is averaged
  int num_samples = 1000, num_few_samples = 300;  ///< points for measuring and for screening a rotation
  using Widths = std::array<double, 6>;
  Widths fit_widths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};        ///< widths of the weights of a fit, tolerances
  Widths close_fit_widths{3.0, 2.0, 1.5, 1.0, 0.7, 0.7};  ///< the same for a fit that starts where another fit ended
  double min_free_miss = 0.5;  ///< distance from the rim, tolerances, from which points in free space pull the line
  double fit_reach = 2.0;      ///< distance beyond which a match has no weight, widths
  double fit_ridge = 1e-3;     ///< ridge that keeps unconstrained directions at rest, as a share of the trace
  /// Greatest step of a fit, radians and radii; starts are closer, and larger steps leave the basin.
  double longest_step = 0.1;
  double fit_step = 1e-4;  ///< step of the derivatives, radians and radii
  double min_f = 1e-6;     ///< least f, below any f that is not 0
  /// Tolerances beyond which a part counts as far, as in ObjectSymmetryOptions::max_feature.
  double far_tolerances = 10.0;
  double slack_of_reach = 1.001;  ///< factor on the reach, greater than the rounding of distances
  /// Greatest shares of the points mapped into free space, and far into it, for folds.
  double max_off = 0.05, max_far = 0.0125;
  double max_round_off = 0.015, max_round_far = 0.004;  ///< the same for round bodies
  /// Least shares of the points mapped onto the surface, for round bodies, for folds, and for folds of 2.
  double round_on = 0.6, fold_on = 0.3, twofold_on = 0.75;
  double halfway_more = 0.06;  ///< least additional share of the points that rotations halfway map into free space
  int num_plane_pairs = 24;    ///< number of pairs of perpendicular planes through a line that are screened
  double plane_slack = 2.0;    ///< greatest distance of a point on the surface in that screening, tolerances
  double upright_angle = 6.0 * kDegree,
         crossing_gap = 0.06;  ///< limits for lines that cross at a right angle: angle and distance
  /// Weight of the share on the surface relative to that in free space, in the choice of a pair of planes.
  double landed_counts = 0.1;
  /// Additional share of the points that rotations halfway map into free space, above which more makes no difference.
  double max_halfway = 0.3;
  double negligible_share = 2e-3;      ///< unit of shares in the log odds: less is negligible
  double negligible_of_planes = 5e-3;  ///< the same for planes, which are screened in steps
  double max_not_round = 0.3;          ///< greatest share of the points that a nearly round body has off its round part
  double min_mapped = 0.25;     ///< least share of these points that a plane through the axis maps onto the surface
  double min_stiffness = 1e-3;  ///< least stiffness of a line that the scan constrains; boxes have 0.05
};

inline constexpr ScanAxisRules kScanAxes;

/// The least margin to a limit, >= 0 if all limits are kept. It compares the orders of a line, and different lines;
/// rotationConfidence(), which is reported, is fitted to lines chosen in this way.
/// \param rotation rotation with its shares of visible points.
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
  /// \param slack distance of a point on the surface, tolerances.
  /// \param max_off,max_far shares above which the remaining points are skipped.
  RotationShares screen(const Eigen::Affine3d& motion, double slack, double max_off, double max_far) const;

  /// Measures a rotation by distances from the surface.
  RotationShares measure(const Eigen::Affine3d& motion) const;

  /// \param line axis of a nearly round body.
  /// \return indices into samples_ of the points that some rotation about the line maps far into free space, such as a
  /// handle.
  std::vector<int> notRound(const Line3d& line) const;

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
  Line3d refined(const Line3d& line, const std::vector<double>& angles) const;

  /// The same from a nearly correct line, with more points and narrower weights.
  Line3d closelyRefined(const Line3d& line, const std::vector<double>& angles) const;

  const NormalizedCloud& cloud() const { return cloud_; }

private:
  /// Normal equations of a small motion of a line: two tilts and two translations.
  struct Pulls {
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  };

  Points moved(const Eigen::Affine3d& motion, const std::vector<int>& samples) const;
  /// Maps the samples; distances beyond the reach are not measured.
  Landing landed(const Eigen::Affine3d& motion) const;
  /// \param width width of the weights, tolerances.
  /// \param[in,out] closest closest points to the moved samples, for a line nearby; -1 = not known.
  void addPulls(const IspSurface& surface, const Line3d& line, double angle, const std::vector<int>& samples,
                double width, std::vector<int>& closest, Pulls& pulls) const;
  Line3d fitted(const IspSurface& surface, const Line3d& start, const std::vector<double>& angles,
                const std::vector<int>& samples, const ScanAxisRules::Widths& widths) const;
  /// Whether a point lies in free space. The rim of the visible surface is as exact as its pixels.
  bool isFree(const Eigen::Vector3d& x) const {
    return isFreeSpace(*cloud_.visibility, x, tolerance_, std::max(tolerance_, cloud_.spacing));
  }

  const NormalizedCloud& cloud_;
  double tolerance_;
  double far_, reach_;  ///< distance from which points are far, and distance up to which they are measured
  std::vector<int> samples_, few_samples_;
  Points facing_;  ///< normals, oriented toward the scanner
};

/// Evidence for a twofold rotation of a scan besides the shares of SymmetryRotation: such a rotation maps most points
/// into occluded space, and a flat side that is mapped onto itself is weak evidence.
struct RotationSigns {
  double grown = 1.0;  ///< extent of the points and their images together, divided by the extent of the points; >= 1
  double stiffness = 1.0;  ///< see RotationEvidence::stiffness()
  /// Share of points reflected into free space by the worse of two perpendicular planes through the line, for the best
  /// such pair: most objects with a twofold axis have two such planes of symmetry.
  double planes_off = 0.0;
  /// 1 if another rotation of the scan fits better and the two lines do not cross at a right angle, as twofold axes of
  /// prisms do.
  double beside = 0.0;
};

/// A rotation that was judged, whatever its confidence.
struct JudgedRotation {
  SymmetryRotation rotation;  ///< input frame
  RotationSigns signs;
};

/// \param rotations rotations of one scan, input frame, with their shares of visible points.
/// \param min_confidence planes are not searched if the other evidence gives a rotation less, see rotationConfidence().
/// \return one entry per rotation; only twofold rotations have other values than the defaults.
std::vector<RotationSigns> rotationSigns(const RotationEvidence& evidence,
                                         const std::vector<SymmetryRotation>& rotations, double min_confidence = 0.0,
                                         int num_threads = 1);

/// Kinds of rotations with their own coefficients: a twofold one hides most of its evidence.
enum class RotationKind { AnyAngle, Half, Folds };

RotationKind kindOf(const SymmetryRotation& rotation);

/// Terms of the log odds that rotations of a scan are symmetries of the whole object; the first is 1. Their
/// coefficients are fitted by test/benchmark/fit_rotations.py.
/// \param rotation rotation with its shares of visible points.
std::vector<double> rotationOddsTerms(const SymmetryRotation& rotation, const RotationSigns& signs);

/// Probability that the rotations map at least 90 % of the whole surface to within 1 % of the diameter of the surface,
/// and all but 1.25 % to within ten times that.
/// \param rotation rotation with its shares of visible points.
double rotationConfidence(const SymmetryRotation& rotation, const RotationSigns& signs);

}  // namespace pcl_symmetry
