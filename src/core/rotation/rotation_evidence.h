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
      normals_in_draw = 8;               ///< samples, draws and normals per draw for lines of bodies of revolution
  int from_normals = 3;                  ///< lines kept of these
  double angle_of_fold = 3.0 * kDegree;  ///< error of planes of scans
  double min_plane_angle = 0.13;         ///< between two planes that share a line
  int coarse_cells = 24, coarse_theta = 8, coarse_phi = 32, coarse_offset = 8, coarse_samples = 32;
  double coarse_reach = 0.67;                     ///< radii; greatest distance of an axis from the middle of the cloud
  std::size_t coarse_maxima = 10;                 ///< of that axial transform
  double coarsely_same = 0.3;                     ///< radians and radii, within which two of them are one
  double coarse_equal = 0.05;                     ///< difference of D from the peaks
  int max_order = 12;                             ///< bodies of more folds look nearly round in a scan
  int round_rotations = 10;                       ///< rotations that represent all, besides small ones
  double small_angle = 0.26, larger_angle = 0.7;  ///< angles that the fit of a round body uses
  double rough_factor = 3.0, rough_slack = 2.0;   ///< of max_off and max_far in screening; tolerances
  std::size_t max_planes_of_axes = 8;             ///< planes whose common lines are starts
  double plane_share = 0.85;                      ///< least share of such planes
  double same_axis_angle = 0.12, same_axis_offset = 0.1;  ///< no body has two axes nearer
  double fitted_same = 0.02;                              ///< radians and radii, within which lines are judged once
  std::size_t max_axes = 5;                               ///< axes; a polyhedron seen from a corner shows as many
  int scored_planes = 4;                                  ///< planes over which D of a round body is averaged
  int num_samples = 1000, num_few_samples = 300;          ///< points for measuring and for screening a rotation
  using Widths = std::array<double, 6>;
  Widths fit_widths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};        ///< widths of the weights of a fit, tolerances
  Widths close_fit_widths{3.0, 2.0, 1.5, 1.0, 0.7, 0.7};  ///< the same for a fit that starts where another one ended
  double min_free_miss = 0.5;     ///< tolerances from the rim beyond which points in free space pull
  double fit_reach = 2.0;         ///< widths beyond which a match has no weight
  double fit_ridge = 1e-3;        ///< share of the trace that keeps free directions at rest
  double longest_step = 0.1;      ///< radians, radii, of a fit; starts are closer, larger steps leave the basin
  double fit_step = 1e-4;         ///< of derivatives, radians and radii
  double min_f = 1e-6;            ///< below any f that is not 0
  double far_tolerances = 10.0;   ///< as ObjectSymmetryOptions::max_feature
  double slack_of_reach = 1.001;  ///< more than what distances are rounded by
  double max_off = 0.05, max_far = 0.0125;                  ///< greatest shares mapped into free space, for folds
  double max_round_off = 0.015, max_round_far = 0.004;      ///< the same for round bodies
  double round_on = 0.6, fold_on = 0.3, twofold_on = 0.75;  ///< least shares mapped onto the surface, by kind
  double halfway_more = 0.06;  ///< additional share that rotations halfway map into free space
  int num_plane_pairs = 24;    ///< pairs of perpendicular planes through a line that are screened
  double plane_slack = 2.0;    ///< tolerances of that screening
  double upright_angle = 6.0 * kDegree,
         crossing_gap = 0.06;          ///< limits for lines that cross at a right angle: angle and distance
  double landed_counts = 0.1;          ///< weight of the share on the surface relative to that in free space
  double max_halfway = 0.3;            ///< share of the points above which all folds are alike
  double negligible_share = 2e-3;      ///< share of the points that is negligible
  double negligible_of_planes = 5e-3;  ///< the same for planes, which are screened in steps
  double max_not_round = 0.3;          ///< share of the points of a body that is round otherwise
  double min_mapped = 0.25;            ///< share of these points that a plane through its axis maps onto the surface
  double min_stiffness = 1e-3;         ///< least stiffness of a line that the scan constrains; boxes have 0.05
};

inline constexpr ScanAxisRules kScanAxes;

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

/// Shares of the visible points by where a rotation about a line maps them. The rest lands in occluded space.
struct RotationShares {
  double on = 0.0;   ///< lands within the tolerance of the surface seen
  double off = 0.0;  ///< lands in free space, beyond the tolerance
  double far = 0.0;  ///< lands there beyond ten tolerances: a handle, not a dent
};

/// Judges rotations by the visible surface and the free space in front of it. Not in the paper.
class RotationEvidence {
public:
  /// \param cloud of a scan; must outlive this.
  /// \param tolerance normalized frame.
  RotationEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed);

  /// Screens a rotation by distances from the EDT at a few points.
  /// \param slack tolerances.
  /// \param max_off,max_far shares beyond which the remaining points are skipped.
  RotationShares screen(const Eigen::Affine3d& motion, double slack, double max_off, double max_far) const;

  /// Measures a rotation by distances from the surface.
  RotationShares measure(const Eigen::Affine3d& motion) const;

  /// \param line about which the points are round otherwise.
  /// \return those samples of exactly() that some rotation about the line maps far into free space, such as a handle.
  std::vector<int> notRound(const Line3d& line) const;

  /// \param some of the samples of exactly(), at least one.
  /// \return share of them that a motion maps onto the surface.
  double shareOn(const Eigen::Affine3d& motion, const std::vector<int>& some) const;

  /// How strongly the matches of a rotation constrain its line: second smallest eigenvalue of the point-to-plane
  /// stiffness under two tilts and two shifts; mean over the points, radii. The smallest one is small for all surfaces
  /// that slide.
  double stiffness(const Line3d& line, double angle) const;

  /// The line moved to where some rotations about it best map the visible points onto each other: point to plane, with
  /// weights that fall with the distance and the angle between the normals. A side that faces away from the scanner has
  /// no matches. Matches at borders do not count, as the true one may be hidden, unless the point lands in free space:
  /// the border then pulls it back.
  Line3d refined(const Line3d& line, const std::vector<double>& angles) const;

  /// The same from a nearly correct line, with more points and narrower weights.
  Line3d closelyRefined(const Line3d& line, const std::vector<double>& angles) const;

  const NormalizedCloud& cloud() const { return cloud_; }

private:
  /// Normal equations of a small motion of a line: two tilts and two shifts.
  struct Pulls {
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  };

  Points moved(const Eigen::Affine3d& motion, const std::vector<int>& samples) const;
  /// The distance of points beyond the reach is not measured.
  Landing landed(const Eigen::Affine3d& motion) const;
  /// \param width of the weights, tolerances.
  /// \param[in,out] closest points to the moved samples, of a line nearby; -1 where none is known.
  void addPulls(const IspSurface& surface, const Line3d& line, double angle, const std::vector<int>& samples,
                double width, std::vector<int>& closest, Pulls& pulls) const;
  Line3d fitted(const IspSurface& surface, const Line3d& start, const std::vector<double>& angles,
                const std::vector<int>& samples, const ScanAxisRules::Widths& widths) const;
  /// The rim of the visible surface is as exact as its pixels.
  bool isFree(const Eigen::Vector3d& x) const {
    return isFreeSpace(*cloud_.visibility, x, tolerance_, std::max(tolerance_, cloud_.spacing));
  }

  const NormalizedCloud& cloud_;
  double tolerance_;
  double far_, reach_;  ///< distances: from which points are far, and within which they are measured
  std::vector<int> samples_, few_samples_;
  Points facing_;  ///< normals, toward the scanner
};

/// Evidence for a twofold rotation of a scan besides the shares of SymmetryRotation: it maps most points to occluded
/// space, and a flat side that lands on itself is weak evidence.
struct RotationSigns {
  double grown = 1.0;      ///< extent of points and images together, divided by that of the points; >= 1
  double stiffness = 1.0;  ///< RotationEvidence::stiffness()
  /// Minimum over pairs of perpendicular planes through the line of the greater share of points that either plane
  /// reflects into free space: most objects with a twofold axis have such planes.
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

/// \param rotations of one scan, input frame, with the shares that were seen.
/// \param min_confidence planes are not searched if the other signs give a rotation less, see rotationConfidence().
/// \return one each; other rotations than twofold ones have the defaults.
std::vector<RotationSigns> rotationSigns(const RotationEvidence& evidence,
                                         const std::vector<SymmetryRotation>& rotations, double min_confidence = 0.0,
                                         int num_threads = 1);

/// Kinds of rotations with their own coefficients: a twofold one hides most of its evidence.
enum class RotationKind { AnyAngle, Half, Folds };

RotationKind kindOf(const SymmetryRotation& rotation);

/// Terms of the log odds that rotations of a scan are symmetries of the whole object; the first is 1. Their
/// coefficients are fitted by test/benchmark/fit_rotations.py.
/// \param rotation with the shares that were seen.
std::vector<double> rotationOddsTerms(const SymmetryRotation& rotation, const RotationSigns& signs);

/// Probability that the rotations map at least 90 % of the whole surface to within 1 % of the diameter of the surface,
/// and all but 1.25 % to within ten times that: the limits of ObjectSymmetryOptions.
/// \param rotation with the shares that were seen.
double rotationConfidence(const SymmetryRotation& rotation, const RotationSigns& signs);

}  // namespace pcl_symmetry
