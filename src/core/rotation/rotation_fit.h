#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/geometry/closest_point_grid.h"
#include "core/geometry/surface_discs.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// Rotations about one center that move together: a group, a part of a group, or turns about one axis.
struct RotationSet {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::size_t num_judged = 0;  ///< rotations at the front that are judged; the others follow from them

  /// \return the image of \p x under rotation \p i.
  Eigen::Vector3d image(std::size_t i, const Eigen::Vector3d& x) const { return center + rotations[i] * (x - center); }
};

/// How much of the surface a rotation maps off the surface, as shares of the area in [0, 1].
struct OffShares {
  double off = 0.0;  ///< more than the tolerance, relative to what the samples reach on themselves
  double far = 0.0;  ///< more than ten tolerances: parts that stick out, such as a handle
};

/// What symmetric means: tolerance tau and feature share phi (ObjectSymmetryOptions).
struct RotationLimits {
  double tolerance;    ///< normalised frame
  double max_feature;  ///< share of the surface that may be off

  /// By how much a rotation fails: the greater of its two shares over what is allowed of each.
  /// \return <= 1 for a symmetry.
  double excess(const OffShares& shares) const;
  /// Probability that rotations of these measured shares are symmetries at the limits.
  /// \param num_points that the shares are of.
  double confidence(const OffShares& shares, std::size_t num_points) const;
};

/// The surface that rotations are compared with, fitted to and judged on.
///
/// Rotations are fitted as planes are: ISP (Section 4.4) with rotations in place of reflections. They are judged by the
/// share of the surface that they map to within the tolerance of the surface. All lengths are in the normalised frame.
class RotationFit {
public:
  /// \param points 3 x N, normalised to the unit ball about 0.
  /// \param edt distance transform of these points; must outlive this object.
  /// \param tolerance normalised frame; the greatest that judges, unless fitsAt() says otherwise.
  /// \param reach greatest tolerance that fits derived from this one judge at.
  /// \param seed of the samples.
  /// \param num_threads >= 0; 0 = one per core.
  RotationFit(Points points, const GaussianEdt& edt, RotationLimits limits, double reach, std::uint64_t seed,
              int num_threads);

  /// The same surface judged at other limits.
  /// \param limits tolerance at most the reach.
  RotationFit withLimits(RotationLimits limits) const;

  const Points& points() const { return surface_->points; }
  const RotationLimits& limits() const { return limits_; }

  /// Mean of f at some rotated points: a rough and quick answer.
  /// \return about 1 for a symmetry.
  double overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                 int num_points = std::numeric_limits<int>::max()) const;
  /// The least overlap of any rotation of a set, at most 1.
  double overlap(const RotationSet& set) const;

  /// The set turned and moved as a whole to where the rotated samples lie closest to the surface: few samples, wide
  /// weights.
  RotationSet roughlyFitted(const RotationSet& set) const;
  /// The same with many samples and narrow weights: what is off by more than the tolerance hardly counts.
  RotationSet closelyFitted(const RotationSet& set) const;

  /// What one rotation maps off the surface.
  /// \param num_samples of the points, the same ones each time; at least as many as there are: all.
  OffShares offShares(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                      int num_samples = std::numeric_limits<int>::max()) const;

  /// The worst of the judged rotations of a set.
  /// \param most stops at a rotation whose excess is greater.
  OffShares worstShares(const RotationSet& set, int num_samples = std::numeric_limits<int>::max(),
                        double most = std::numeric_limits<double>::infinity()) const;

  /// See RotationLimits::confidence().
  double confidence(const OffShares& shares) const;

  /// Center of the samples that a rotation maps off the surface.
  Eigen::Vector3d whereOff(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const;

private:
  /// Widths of the Gaussian weights from first to last iteration.
  struct Annealing {
    double sigma, final_sigma;
    int max_iterations;
    bool rough;  ///< closest samples by grid instead of closest discs
  };
  struct NormalEquations;
  /// What does not depend on the tolerance.
  struct Surface {
    Points points;
    LocalGeometry geometry;
    std::unique_ptr<SurfaceDiscs> discs;
    std::unique_ptr<ClosestPointGrid> grid;
    std::vector<float> own_distances;
    std::vector<int> order;  ///< a random order of the points
    double spacing = 0.0, roughness = 0.0;
    Points overlap_points;     ///< that overlap() asks about
    double own_overlap = 1.0;  ///< that a perfect symmetry reaches with this sampling
  };

  int closestSample(const Eigen::Vector3f& x) const;
  double ownShare() const;
  NormalEquations equations(const RotationSet& set, std::size_t i, int num_samples, const Annealing& annealing) const;
  RotationSet fitted(RotationSet set, const std::vector<std::size_t>& used, int num_samples, Annealing annealing) const;

  std::shared_ptr<const Surface> surface_;
  const GaussianEdt& edt_;
  RotationLimits limits_;
  double own_share_;    ///< of the samples within the tolerance of the discs of the others
  double first_sigma_;  ///< of close fits
  double last_sigma_;
  int num_threads_;
};

}  // namespace pcl_symmetry
