#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/small_motion.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/surface_normals.h"
#include "core/rotation/rotation_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

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
  RotationSet fitRoughly(const RotationSet& set) const;
  /// The same with many samples and narrow weights: samples that are off by more than the tolerance hardly count.
  RotationSet fitClosely(const RotationSet& set) const;

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
    std::vector<float> leave_one_out_distances;
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
  RotationSet fitRotations(RotationSet set, const std::vector<int>& used, int num_samples, Annealing annealing) const;

  std::shared_ptr<const Surface> surface_;
  const GaussianEdt& edt_;
  RotationLimits limits_;
  double own_share_;    ///< share of the samples within the tolerance of the discs of the others
  double first_sigma_;  ///< width of the weights at the start of close fits
  double last_sigma_;
  int num_threads_;
};

}  // namespace pcl_symmetry
