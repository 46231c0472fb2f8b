#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Some pairs of a sample and the closest point to its reflection, coordinate by coordinate.
struct PairBlock {
  static constexpr int kMost = 128;  ///< pairs. 13 KB, so that a block stays in the first cache
  using Coordinates = double[3][kMost];

  int size = 0;
  Coordinates x, y;  ///< samples, and the points that they are paired with
  Coordinates x_normals, y_normals;
  double weights[kMost];  ///< >= 0
};

/// What the pairs of a block add to the sums of one kind of step, each for itself.
struct StepTerms {
  static constexpr int kSums = 12;  ///< a matrix of 3 x 3 and a vector

  int size = 0;
  double values[kSums][PairBlock::kMost];
};

/// Normal equations of a plane's step. The unknowns (a, b, c) move the normal n by a u + b v, and the plane's distance
/// from the middle of the samples by extent * c.
///
/// Sums are taken pair by pair, so that they do not depend on how many terms a processor works out at once.
struct StepEquations {
  Eigen::Vector3d n, u, v;
  Eigen::Vector3d middle;
  double extent;
  double offset;                                ///< of the plane from the middle
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();  ///< the lower half is used
  Eigen::Vector3d g = Eigen::Vector3d::Zero();

  /// \param middle_of_samples,extent_of_samples weighted mean, and root mean square distance from it.
  StepEquations(const ReflectionPlane& plane, const Eigen::Vector3d& middle_of_samples, double extent_of_samples);

  /// Terms of w (m . (x' - y))^2 of each pair, where m is the mean direction of the normal at y and the reflected
  /// normal at x. The upper half of h stays 0.
  void pointToPlane(const PairBlock& pairs, StepTerms& terms) const;

  /// Terms of w |x' - y|^2 of each pair.
  void pointToPoint(const PairBlock& pairs, StepTerms& terms) const;

  void add(const StepTerms& terms);

  ReflectionPlane moved(const Eigen::Vector3d& step) const;
};

}  // namespace pcl_symmetry
