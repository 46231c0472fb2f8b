#pragma once

#include <cstdint>
#include <vector>

#include "core/normals/surface_normals.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

/// Rotations about one center that move together: a group, a part of a group, or turns about one axis.
struct RotationSet {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::size_t num_judged = 0;  ///< rotations at the front that are judged; the others follow from them

  /// \return the image of \p x under rotation \p i.
  Eigen::Vector3d image(std::size_t i, const Eigen::Vector3d& x) const { return center + rotations[i] * (x - center); }
};

/// What the surface says about rotations.
struct RotationEvidence {
  double support = 0.0;  ///< share of the surface mapped onto the surface, as far as sampling lets it, in [0, 1]
  /// Share of the surface that a rotation maps off it in one or more pieces together, in [0, 1]: the greatest of any
  /// rotation. A piece is where most neighbouring samples are off; single samples are off by chance and do not count.
  double feature = 0.0;
  double confidence = 0.0;  ///< probability that the rotations together are symmetries, in [0, 1]
};

/// The surface that rotations are compared with, fitted to and judged on.
///
/// Rotations are treated as planes are: ISP (Section 4.4) with rotations in place of reflections, then the support of
/// planes. All lengths are in the normalised frame.
class RotationFit {
public:
  /// \param points 3 x N, normalised to the unit ball about 0.
  /// \param edt distance transform of these points; must outlive this object.
  /// \param seed of the samples.
  /// \param num_threads >= 0; 0 = one per core.
  RotationFit(Points points, const GaussianEdt& edt, std::uint64_t seed, int num_threads);

  const Points& points() const { return points_; }

  /// Mean of f at some rotated points: a rough and quick answer.
  /// \return about 1 for a symmetry.
  double overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const;
  /// The least overlap of any rotation of a set, at most 1.
  double overlap(const RotationSet& set) const;

  /// The set turned and moved as a whole to where the rotated samples lie closest to the surface: few samples, wide
  /// weights.
  RotationSet roughlyFitted(const RotationSet& set) const;
  /// The same with many samples and narrow weights.
  RotationSet closelyFitted(const RotationSet& set) const;

  /// The least support of the judged rotations, from some of the points.
  double roughSupport(const RotationSet& set) const;
  /// The evidence of the judged rotations together, from all points.
  RotationEvidence evidence(const RotationSet& set) const;

private:
  /// Widths of the Gaussian weights from first to last iteration.
  struct Annealing {
    double sigma, final_sigma;
    int max_iterations;
  };
  struct NormalEquations;

  NormalEquations equations(const RotationSet& set, std::size_t i, const std::vector<int>& samples, double sigma) const;
  RotationSet fitted(RotationSet set, const std::vector<std::size_t>& used, const std::vector<int>& samples,
                     Annealing annealing) const;
  std::vector<float> support(const RotationSet& set, std::size_t i, const std::vector<int>& samples) const;
  double confidence(double support, double score) const;
  double featureShare(const std::vector<float>& support) const;
  double score(const RotationSet& set, std::size_t i) const;

  Points points_;
  const GaussianEdt& edt_;
  int num_threads_;
  ClosestPointSearch::Ptr search_;
  LocalGeometry geometry_;
  double spacing_, roughness_, baseline_;     // as in PlaneEvidence
  double sigma_, final_sigma_;                // of the weights: of the distance transform, and of the points' spacing
  std::vector<int> few_, some_, many_, all_;  // samples of rough fits, rough support, close fits, and evidence
  Points overlap_points_;                     // that overlap() asks about
  double own_overlap_;                        // overlap that a perfect symmetry reaches with this sampling
  double own_feature_;                        // feature that the surface has against itself
};

}  // namespace pcl_symmetry
