#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/small_motion.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// Parameters that affect the search for rotations. Lengths are in radii of the bounding ball and angles in radians,
/// unless stated otherwise.
struct RotationRules {
  // Failures, as shares of the surface
  // Tolerances beyond which a piece of surface sticks out: 10 % of the diameter, as in BOP.
  double far_tolerances = 10.0;
  double far_of_feature = 0.125;  // greatest share of the surface that may stick out, as a share of max_feature
  double min_far = 0.002;         // least value of that share: single samples at sharp edges are far by chance
  double optimism = 1.3;          // true excess divided by the fitted cloud's; 1.28 on 98 groups of 354 models of PSB
  double share_unit = 0.02;       // uncertainty of a share: with it, the confidences of these groups are calibrated
  double share_errors = 0.5;      // standard errors by which that uncertainty grows for few points
  // Greatest excess of the worst of the rotations that represent all rotations, whose mean may be 1.
  double max_worst = 1.25;
  double max_errors = 3.0;    // standard errors by which a share of some of the points may be off
  double gain_of_fit = 0.03;  // share of the surface that a close fit may gain
  // Least ratio of the excess halfway between the rotations of a fold to the excess of the fold itself.
  double clear_factor = 1.5;
  double clear_excess = 0.2;  // least difference of these two excesses

  // Resolution of points
  double min_own_share = 0.5;  // least share of the points within the tolerance of the surface of the others
  // Resolution of a sparse surface that is accepted, tolerances: its uncertainty lowers the confidence.
  double surface_slack = 1.5;
  int body_neighbors = 50;  // neighbors by which solid bodies are recognized, at most a quarter of the points
  // Least thickness over length of such a neighborhood in a body: 0.75 inside, balls of 200 points 0.57 to 0.69, bowls
  // as thin as their spacing 0.45.
  double body_thickness = 0.56;
  // Fewer neighbors, which distinguish a body from walls a few spacings thick, whose two surfaces are flat.
  int close_neighbors = 8;
  // Least thickness over length of such a neighborhood: 0.4 in a body, at most 0.25 in a flat surface.
  double close_thickness = 0.32;
  int border_neighbors = 30;  // neighbors by which the border of a body is recognized
  // Least distance of a border point from their mean, in distances of the farthest one: 3/8 at a flat border, 0.14
  // inside by chance.
  double border_offset = 0.27;
  // Tolerance for points compared one by one, in median distances to the closest point: 8 % of images are within it by
  // chance.
  double single_distance = 0.5;
  Eigen::Index max_single_points = 50'000;  // greatest number of points that are compared one by one

  // Fits: Iterative Symmetric Points, whose steps and weights kRefinement limits
  int num_overlap_points = 256;   // points of overlap()
  int num_rough_points = 200;     // points of rough fits
  int num_close_points = 1000;    // points of close fits
  int num_some_points = 600;      // points that show whether a close fit is worth judging by all points
  int rough_iterations = 8;       // greatest number of iterations of rough fits
  int close_iterations = 12;      // greatest number of iterations of close fits
  double first_tolerances = 2.0;  // width of the weights at the start, tolerances, unless first_spacings is more
  // Width of the weights at the start, spacings of the points, unless first_tolerances is more.
  double first_spacings = 1.0;
  double last_tolerances = 0.7;   // width of the weights at the end, tolerances, unless last_roughnesses is more
  double last_roughnesses = 3.0;  // width of the weights at the end, roughnesses, unless last_tolerances is more
  double settled_step = 2e-4;     // step that ends the fit: a hundredth of the default tolerance
  std::size_t max_fitted = 6;     // greatest number of rotations of a large group that are fitted, spread over it
  double rough_overlap = 0.6;     // least overlap of a set before its fit
  double fair_overlap = 0.7;      // least overlap of a set after its rough fit

  // Axes
  double same_line = 0.05;        // angle and distance within which lines are one
  double min_line_overlap = 0.6;  // least overlap of a line that is tried
  int num_first_points = 48;      // points that rule out most lines
  double first_overlap = 0.42;    // least overlap of these points: min_line_overlap less three standard errors
  // Greatest number of directions kept for each order: as many as axes of order 5 of the icosahedron.
  std::size_t max_directions = 6;
  double min_angle = 0.17;  // least angle between kept directions
  double near_best = 0.05;  // deficit of the overlap to the best one up to which a smaller fold is as likely
  int small_fold = 6;       // folds up to this one are tried whatever the overlap of greater ones
  // Greatest surplus of the overlap of the rotation by half the angle of a fold over the overlap of the fold.
  double half_allowance = 0.03;
  double min_overlap = 0.5;      // least overlap of the likeliest rotation about a line before its fit
  double clearly_better = 0.02;  // least surplus of the overlap of a greater fold over a smaller one
  std::size_t max_axes = 12;     // greatest number of axes: enough to determine any finite group
  std::size_t max_folds = 3;     // greatest number of folds of a line that are fitted, the greatest first
  int min_pattern = 3;           // least fold of equal pieces around a line that are a pattern rather than features
  double pattern_excess = 0.5;   // excess of the worst rotation from which a pattern is searched for
  double max_tolerance_of_radius =
      0.06;  // a bar 3 % as thick as long keeps its corners, a polygon of 12 sides is round

  // Groups
  double axes_meet = 0.1;     // difference up to which the angles between two found axes and two axes of a group agree
  double across_step = 0.02;  // step of the search for half turns about axes perpendicular to the main one
};
inline constexpr RotationRules kRotation;

/// Rotations about one center that move together: a group, a part of a group, or rotations about one axis.
struct RotationSet {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::size_t num_judged = 0;  ///< number of rotations at the front that are judged; the others follow from them

  /// \return the image of \p x under rotation \p i.
  Eigen::Vector3d image(std::size_t i, const Eigen::Vector3d& x) const { return center + rotations[i] * (x - center); }
};

/// Shares of the surface that a rotation maps off the surface, by area, in [0, 1].
struct OffShares {
  double off = 0.0;  ///< share beyond the tolerance, less the share of the samples themselves
  double far = 0.0;  ///< share beyond ten tolerances: parts that stick out, such as a handle
};

/// Definition of a symmetry: tolerance tau and feature share phi (ObjectSymmetryOptions).
struct RotationLimits {
  double tolerance;    ///< normalized frame
  double max_feature;  ///< share of the surface that may be off

  /// The greater of the ratios of the two shares to their allowed values.
  /// \return <= 1 for a symmetry.
  double excess(const OffShares& shares) const;
  /// Probability that rotations with these measured shares keep within the limits.
  /// \param num_points number of points by which the shares were measured.
  double confidence(const OffShares& shares, std::size_t num_points) const;
};

/// The surface that rotations are compared with, fitted to and judged on.
///
/// Rotations are fitted as planes are: ISP (Section 4.4) with rotations in place of reflections. They are judged by the
/// share of the surface that they map to within the tolerance of the surface. All lengths are in the normalized frame.
class RotationFit {
public:
  /// \param points 3 x N, normalized to the unit ball about 0.
  /// \param edt distance transform of these points; must outlive this object.
  /// \param limits definition of a symmetry; tolerance at most \p reach.
  /// \param reach greatest tolerance of withLimits().
  /// \param seed seed of the samples.
  /// \param single each point has to meet another one: judges the points, not a surface.
  RotationFit(Points points, const GaussianEdt& edt, RotationLimits limits, double reach, std::uint64_t seed,
              int num_threads, bool single = false);

  /// The same surface, judged at other limits.
  /// \param limits tolerance at most the reach.
  RotationFit withLimits(RotationLimits limits) const;

  const Points& points() const { return surface_->points; }
  const RotationLimits& limits() const { return limits_; }

  /// Whether the points fill a body, as solid samples and atoms do.
  bool fillsBody() const;
  /// The points at the border of such a body.
  Points borderPoints() const;
  /// The least tolerance at which the points show a surface: half of them lie on the surface of the others.
  double resolution() const;
  /// Median distance between a point and the one closest to it.
  double closestDistance() const { return surface_->closest_distance; }

  /// Mean of f at some rotated points: a fast estimate.
  /// \return about 1 for a symmetry.
  double overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                 int num_points = std::numeric_limits<int>::max()) const;
  /// The least overlap of any rotation of a set, at most 1.
  double overlap(const RotationSet& set) const;

  /// The set, rotated and moved as a whole to where the rotated samples lie closest to the surface: few samples, wide
  /// weights.
  RotationSet roughlyFitted(const RotationSet& set) const;
  /// The same with many samples and narrow weights: samples that are off by more than the tolerance hardly count.
  RotationSet closelyFitted(const RotationSet& set) const;

  /// The shares that one rotation maps off the surface.
  /// \param num_samples number of points by which it is judged, the same ones each time; all if there are no more.
  OffShares offShares(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                      int num_samples = std::numeric_limits<int>::max()) const;

  /// The shares of the worst of the judged rotations of a set.
  /// \param max_excess stops at a rotation with a greater excess.
  OffShares worstShares(const RotationSet& set, int num_samples = std::numeric_limits<int>::max(),
                        double max_excess = std::numeric_limits<double>::infinity()) const;

  /// See RotationLimits::confidence().
  double confidence(const OffShares& shares) const;

  /// Center of the samples that a rotation maps off the surface.
  Eigen::Vector3d whereOff(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const;

private:
  /// Thickness over length of the neighborhood of a point, in [0, 1]: the median over some points.
  double thickness(int num_neighbors) const;

  /// Widths of the Gaussian weights from first to last iteration.
  struct Annealing {
    double sigma, final_sigma;
    int max_iterations;
    bool rough;  ///< closest samples from the grid instead of closest discs
  };
  /// The data that do not depend on the tolerance.
  struct Surface {
    Points points;
    ClosestPointSearch::Ptr search;
    LocalGeometry geometry;
    std::unique_ptr<SurfaceDiscs> discs;
    std::unique_ptr<ClosestPointGrid> grid;
    std::vector<float> own_distances;
    std::vector<int> order;  ///< a random order of the points
    double spacing = 0.0, roughness = 0.0;
    Points overlap_points;     ///< points that overlap() looks up
    double own_overlap = 1.0;  ///< overlap of a perfect symmetry with this sampling
    double closest_distance = 0.0;
    bool single = false;
  };

  int closestSample(const Eigen::Vector3f& x) const;
  double ownShare() const;
  /// Least squares of the distances m . (x' - y) in a small rotation of all axes and a translation of the center.
  SmallMotionEquations equations(const RotationSet& set, std::size_t i, int num_samples,
                                 const Annealing& annealing) const;
  RotationSet fitted(RotationSet set, const std::vector<std::size_t>& used, int num_samples, Annealing annealing) const;

  std::shared_ptr<const Surface> surface_;
  const GaussianEdt& edt_;
  RotationLimits limits_;
  double own_share_;    ///< share of the samples within the tolerance of the discs of the others
  double first_sigma_;  ///< width of the weights at the start of close fits
  double last_sigma_;
  int num_threads_;
};

}  // namespace pcl_symmetry
