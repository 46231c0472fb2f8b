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

/// The numbers that axes of scans depend on. Lengths are in radii of the cloud, angles in radians, where no unit is
/// given.
struct ScanAxisRules {
  int normal_samples = 600, normal_draws = 60, normals_in_draw = 8;  ///< that give lines of bodies of revolution
  int from_normals = 3;                                              ///< lines kept of these
  double angle_of_fold = 3.0 * kDegree;                              ///< by which planes of scans are off
  double min_plane_angle = 0.13;                                     ///< between two planes that share a line
  int coarse_cells = 24, coarse_theta = 8, coarse_phi = 32, coarse_offset = 8, coarse_samples = 32;
  double coarse_reach = 0.67;                     ///< radii; greatest distance of an axis from the middle of the cloud
  std::size_t coarse_maxima = 10;                 ///< of that axial transform
  double coarsely_same = 0.3;                     ///< radians and radii, within which two of them are one
  double coarse_equal = 0.05;                     ///< D by which they are off their peaks
  int max_order = 12;                             ///< bodies of more folds are nearly round to a scan
  int round_rotations = 10;                       ///< rotations that represent all, besides small ones
  double small_angle = 0.26, larger_angle = 0.7;  ///< angles that the fit of a round body uses
  double rough_factor = 3.0, rough_slack = 2.0;   ///< of max_off and max_far in screening; tolerances
  std::size_t max_planes_of_axes = 8;             ///< planes whose common lines are starts
  double plane_share = 0.85;                      ///< share of such planes
  double same_axis_angle = 0.12, same_axis_offset = 0.1;  ///< no body has two axes nearer
  double fitted_same = 0.02;                              ///< radians and radii, within which lines are judged once
  std::size_t max_axes = 5;                               ///< axes; a polyhedron seen from a corner shows as many
  int scored_planes = 4;                                  ///< that D of a round body is the mean of
  int num_samples = 1000, num_few_samples = 300;          ///< points that judge a rotation exactly, and roughly
  using Widths = std::array<double, 6>;
  Widths fit_widths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};        ///< of the weights of a fit, tolerances
  Widths close_fit_widths{3.0, 2.0, 1.5, 1.0, 0.7, 0.7};  ///< of a fit that starts where another one ended
  double min_empty_miss = 0.5;                            ///< tolerances from the rim beyond which points pull
  double fit_reach = 2.0;                                 ///< widths beyond which a match has no weight
  double fit_ridge = 1e-3;                                ///< share of the trace that keeps free directions at rest
  double longest_step = 0.1;      ///< radians, radii, of a fit; starts are closer, larger steps leave the basin
  double fit_step = 1e-4;         ///< of derivatives, radians and radii
  double min_f = 1e-6;            ///< below any f that is not 0
  double far_tolerances = 10.0;   ///< as ObjectSymmetryOptions::max_feature
  double slack_of_reach = 1.001;  ///< more than what distances are rounded by
  double max_off = 0.05, max_far = 0.0125;                  ///< shares thrown into empty space, of folds
  double max_round_off = 0.015, max_round_far = 0.004;      ///< of these shares, of round bodies
  double round_on = 0.6, fold_on = 0.3, twofold_on = 0.75;  ///< shares that land on the surface, by kind
  double halfway_more = 0.06;  ///< share that rotations halfway throw more into empty space
  int num_plane_pairs = 24;    ///< pairs of perpendicular planes through a line that are screened
  double plane_slack = 2.0;    ///< tolerances of that screening
  double upright_angle = 6.0 * kDegree, crossing_gap = 0.06;  ///< by which lines may miss a right angle, each other
  double landed_counts = 0.1;                                 ///< what lands on the surface, of what is thrown off it
  double max_halfway = 0.3;                                   ///< share of the points from which on all folds are alike
  double negligible_share = 2e-3;                             ///< share of the points that is negligible
  double negligible_of_planes = 5e-3;                         ///< of planes, which are screened at steps
  double max_not_round = 0.3;                                 ///< share of the points of a body that is round otherwise
  double min_mapped = 0.25;  ///< share of these points that a plane through its axis maps onto the surface
  double min_hold = 1e-3;    ///< least stiffness of a line that the scan holds; boxes have 0.05
};

inline constexpr ScanAxisRules kScanAxes;

/// The least margin to a limit, >= 0 where all are kept: by it the orders of a line and the lines are compared. What is
/// reported is rotationConfidence(), which is fitted to lines that were chosen so.
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

/// Where one rotation about a line maps the points seen, as shares of them. The rest lands in occluded space.
struct RotationShares {
  double on = 0.0;   ///< lands within the tolerance of the surface seen
  double off = 0.0;  ///< lands where the scanner saw that there is nothing, beyond the tolerance
  double far = 0.0;  ///< lands there beyond ten tolerances: a handle, not a dent
};

/// Judges rotations by what a scanner saw: the surface, and the space in front of it. Beyond the paper (Section 6).
class RotationEvidence {
public:
  /// \param cloud of a scan; must outlive this.
  /// \param tolerance normalized frame.
  RotationEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed);

  /// By distances that are read from the EDT at a few points: for screening.
  /// \param slack tolerances.
  /// \param max_off,max_far shares beyond which the rest of the points is left out.
  RotationShares roughly(const Eigen::Affine3d& motion, double slack, double max_off, double max_far) const;

  /// By distances from the surface.
  RotationShares exactly(const Eigen::Affine3d& motion) const;

  /// \param line about which the points are round otherwise.
  /// \return those samples of exactly() that some rotation about the line maps far into free space, such as a handle.
  std::vector<int> notRound(const Line3d& line) const;

  /// \param some of the samples of exactly(), at least one.
  /// \return share of them that a motion maps onto the surface.
  double shareOn(const Eigen::Affine3d& motion, const std::vector<int>& some) const;

  /// How fast the match of a rotation is lost as the line moves: second smallest eigenvalue of its stiffness, point to
  /// plane, under two tilts and two shifts; mean over the points, radii. The smallest is small for all surfaces that
  /// slide.
  double hold(const Line3d& line, double angle) const;

  /// The line moved to where some rotations about it map the points seen onto each other best: point to plane, with
  /// weights that fall with the distance and the angle between the normals. A side that faces away from the scanner
  /// matches nothing that was seen. Matches at borders do not count, as the true one may not have been seen, unless
  /// the point lands where the scanner saw nothing: the border then pulls it back.
  Line3d refined(const Line3d& line, const std::vector<double>& angles) const;

  /// The same from a line that is nearly right, with more points and less wide weights.
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
  /// The rim of what was seen is as exact as its pixels.
  bool isEmpty(const Eigen::Vector3d& x) const {
    return isSeenEmpty(*cloud_.visibility, x, tolerance_, std::max(tolerance_, cloud_.spacing));
  }

  const NormalizedCloud& cloud_;
  double tolerance_;
  double far_, reach_;  ///< distances: from which points are far, and within which they are measured
  std::vector<int> samples_, few_samples_;
  Points facing_;  ///< normals, toward the scanner
};

/// Evidence for a twofold rotation of a scan beside the shares of SymmetryRotation: it maps most points to occluded
/// space, and a flat side that lands on itself confirms little.
struct RotationSigns {
  double grown = 1.0;  ///< extent of the points and their images, in extents of the points; >= 1
  double hold = 1.0;   ///< RotationEvidence::hold()
  /// Least, over pairs of perpendicular planes through the line, of the greater share of the points that one of the two
  /// reflects into free space: most objects with a twofold axis have such planes.
  double planes_off = 0.0;
  /// 1 if a rotation of the same scan fits better, whose line it does not cross at a right angle as twofold axes of
  /// prisms do.
  double beside = 0.0;
};

/// A rotation that was judged, whatever its confidence.
struct JudgedRotation {
  SymmetryRotation rotation;  ///< input frame
  RotationSigns signs;
};

/// \param rotations of one scan, input frame, with the shares that were seen.
/// \param min_confidence planes are not looked for where the other signs leave a rotation less, see rotationConfidence().
/// \return one each; other rotations than twofold ones have the defaults.
std::vector<RotationSigns> rotationSigns(const RotationEvidence& evidence,
                                         const std::vector<SymmetryRotation>& rotations, double min_confidence = 0.0,
                                         int num_threads = 1);

/// Rotations whose confidences have numbers of their own: a twofold one hides most of its evidence.
enum class RotationKind { AnyAngle, Half, Folds };

RotationKind kindOf(const SymmetryRotation& rotation);

/// Terms of the log odds that rotations which a scan shows are symmetries of the whole object; the first is 1. The
/// numbers that they are multiplied with are fitted by test/benchmark/fit_rotations.py.
/// \param rotation with the shares that were seen.
std::vector<double> rotationOddsTerms(const SymmetryRotation& rotation, const RotationSigns& signs);

/// Probability that the rotations map at least 90 % of the whole surface to within 1 % of the diameter of the surface,
/// and all but 1.25 % to within ten times that: the limits of ObjectSymmetryOptions.
/// \param rotation with the shares that were seen.
double rotationConfidence(const SymmetryRotation& rotation, const RotationSigns& signs);

}  // namespace pcl_symmetry
