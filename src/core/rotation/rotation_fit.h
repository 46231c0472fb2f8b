#pragma once

#include <cstdint>
#include <vector>

#include "core/neighbours/surface_normals.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

/// Rotations about one center. They move together: as a group, a part of one, or turns about one axis.
struct RotationSet {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d center;
  std::size_t num_judged;  ///< the first of them, from which the others follow

  Eigen::Vector3d image(std::size_t i, const Eigen::Vector3d& x) const { return center + rotations[i] * (x - center); }
};

/// What the surface says about rotations.
struct RotationEvidence {
  double support = 0.0;     ///< share that is mapped onto the surface, as far as sampling lets it, in [0, 1]
  double feature = 0.0;     ///< greatest share, of any of the rotations, that is mapped off it in one piece
  double confidence = 0.0;  ///< planeConfidence() of the rotations together
};

/// A surface that rotations are compared with, made precise and judged on: by the closest samples of a cloud, in the
/// same way as planes are (Section 4.4, carried over from reflections to rotations).
class RotationFit {
public:
  /// \param points 3 x N, normalised to the unit ball about 0. \param edt of these points; must outlive this object.
  RotationFit(Points points, const GaussianEdt& edt, std::uint64_t seed, int num_threads);

  const Points& points() const { return points_; }

  /// Mean of f at the rotated points, from a few of them: a rough and quick answer, about 1 for a symmetry.
  double overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const;
  double overlap(const RotationSet& set) const;  ///< the least of any

  /// Turns and moves the set as a whole to where the rotated samples lie closest to the surface: in few samples with
  /// wide weights, or in many with narrow ones.
  RotationSet roughlyFitted(const RotationSet& set) const;
  RotationSet closelyFitted(const RotationSet& set) const;

  /// Support from some of the points, of the least of the rotations that are judged.
  double roughSupport(const RotationSet& set) const;
  /// From all points, of the rotations that are judged, together.
  RotationEvidence evidence(const RotationSet& set) const;

private:
  struct Weights {
    double sigma, final_sigma;
    int max_iterations;
  };
  struct NormalEquations;

  NormalEquations equations(const RotationSet& set, std::size_t i, const std::vector<int>& samples, double sigma) const;
  RotationSet fitted(RotationSet set, const std::vector<std::size_t>& used, const std::vector<int>& samples,
                     Weights weights) const;
  std::vector<float> support(const RotationSet& set, std::size_t i, const std::vector<int>& samples) const;
  double featureShare(const std::vector<float>& support) const;
  double score(const RotationSet& set, std::size_t i) const;

  Points points_;
  const GaussianEdt& edt_;
  int num_threads_;
  ClosestPointSearch::Ptr search_;
  LocalGeometry geometry_;
  double spacing_, roughness_, baseline_;
  double sigma_, final_sigma_;
  std::vector<int> few_, some_, many_, all_;
  Points scattered_;  ///< the points that overlap() asks about
  double own_overlap_;
  double own_feature_;
};

}  // namespace pcl_symmetry
