#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/symmetry_map.h"
#include "pcl_symmetry/core/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of sampledTransform().
struct SampledTransformOptions {
  int num_samples = 128;   ///< points drawn for the whole map, in [1, 10^7]; the error falls about as num_samples^-0.7
  std::uint64_t seed = 1;  ///< seed of the points drawn
  int num_threads = 0;     ///< >= 0; 0 = one per core; the map does not depend on it

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The transform by sampling one point of each pair: D(gamma) = (S / |f|^2) mean f(gamma x_i), where the points x_i are
/// drawn with probability f / S, S = sum f, stratified in space, once for the whole map.
///
/// Departure from the paper, which draws both points of a pair (Section 4.3): looking up the second point needs no
/// weights and has no singularity at coincident points.
/// \param edt the function f.
/// \param grid the planes, in the frame of the EDT.
/// \param free_space for a scan, one value per cell of the EDT, x fastest: 1 - f where the scanner looked through the
/// cell, else 0. Empty for a whole object.
/// \return D at the bin centers. With free space (1 + c) D / (D + F + c), c = 0.15, where F is the same mean over the
/// free space: reflected points that the scanner would have seen count against a plane.
/// \throws std::invalid_argument for bad options or free space of another size.
SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options = {},
                             const std::vector<float>& free_space = {});

/// Options of convolutionTransform().
struct ConvolutionTransformOptions {
  /// Spacing of the resampled lattice, in sigmas, in (0, 1]; along one axis it is a whole number of cells, at least
  /// one. 0.5 halves the error and is slower.
  double spacing = 0.9;
  int num_threads = 0;  ///< >= 0; 0 = one per core; the map does not depend on it

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The exact transform by convolution over plane translations (Section 4.2): for each direction n the volume is
/// resampled along n, and one correlation of each line with its reversal gives D for every r at once.
///
/// Departure from the paper: lines are resampled at `spacing` sigmas instead of every cell, because a Gaussian shell of
/// width sigma holds less than 1 % of its spectrum beyond the Nyquist frequency of that lattice. They are correlated
/// directly, because lines of about 36 values are too short for a Fourier transform to pay off.
/// \param edt the function f.
/// \param grid the planes, in the frame of the EDT.
/// \return D at the bin centers.
/// \throws std::invalid_argument for bad options.
SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options = {});

/// Options of rotationalTransform().
struct RotationalTransformOptions {
  double spacing = 0.9;  ///< spacing of the resampled points, in sigmas, in (0, 1]
  /// Share of the planes that are refined by multiresolution, in [0, 1]: all planes are first computed from points and
  /// lines three cells apart, and the share with the greatest D again from points and lines one cell apart. 1 = all
  /// planes are computed once, from those one cell apart.
  double refined_share = 1.0;
  int num_threads = 0;  ///< >= 0; 0 = one per core; the map does not depend on it

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The exact transform by convolution over plane rotations (Section 4.2, Figure 4b): the planes through each of O(n)
/// points are computed at once. A plane through a point contains a line across the axis that the point lies on; about
/// each such line f is resampled in circles, whose correlations with their reversals add up in the frequency domain
/// (Kazhdan et al. 2003).
///
/// The points lie on the three axes of the grid, so that each plane meets an axis in a point at less than 55 degrees
/// from its normal; bins are interpolated between points, lines and angles by cubics. convolutionTransform() computes
/// the same several hundred times faster.
/// \param edt the function f.
/// \param grid the planes, in the frame of the EDT.
/// \return D at the bin centers.
/// \throws std::invalid_argument for bad options.
SymmetryMap rotationalTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                const RotationalTransformOptions& options = {});

/// Options of votingTransform().
struct VotingTransformOptions {
  std::int64_t num_pairs = 2'000'000;  ///< pairs of points drawn, >= 1; the paper's figure for 1 % at 64^3
  /// Cells, >= 0; closer pairs are drawn plane first, see votingTransform(); 0 = the paper as written.
  double near_distance = 4.0;
  std::uint64_t seed = 1;  ///< seed of the pairs drawn
  int num_threads = 0;     ///< >= 0; 0 = one per core; the map does not depend on it

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Monte Carlo voting (Section 4.3): draws pairs (x, x') with probability f(x) f(x') and votes for the plane between
/// them with weight 1 / (2 d^2 sin theta), d = |x - x'|.
///
/// Departure from the paper: that weight has infinite variance as d -> 0, so pairs closer than near_distance do not
/// vote. Their part of the integral is sampled the other way round: x by f, then a plane uniformly in (theta, phi, r)
/// at less than near_distance / 2 from x, with the bounded weight f(x').
/// \param edt the function f.
/// \param grid the planes, in the frame of the EDT.
/// \return D, averaged over each bin by solid angle. The variance of a bin grows with the weights of its votes: a few
/// bins, most of them near the pole, hold several times the greatest D, even more with near_distance 0.
/// \throws std::invalid_argument for bad options.
SymmetryMap votingTransform(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options = {});

/// The choice of an estimator, and the options of each.
struct PlanarTransformOptions {
  TransformMethod method = TransformMethod::Sampled;  ///< estimator that planarTransform() uses
  SampledTransformOptions sampled;                    ///< options of TransformMethod::Sampled
  ConvolutionTransformOptions convolution;            ///< options of TransformMethod::Convolution
  RotationalTransformOptions rotational;              ///< options of TransformMethod::Rotational
  VotingTransformOptions voting;                      ///< options of TransformMethod::Voting

  /// Gives all estimators a seed.
  void setSeed(std::uint64_t seed) { sampled.seed = voting.seed = seed; }
  /// Gives all estimators their number of threads. \param n >= 0; 0 = one per core.
  void setNumThreads(int n) {
    sampled.num_threads = convolution.num_threads = rotational.num_threads = voting.num_threads = n;
  }
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The planar-reflective symmetry transform of f, by the method of the options.
/// \param edt the function f.
/// \param grid the planes, in the frame of the EDT.
/// \param center_of_mass mean of the points, in the same frame.
/// \param visibility what the scanner saw, in the same frame; null for a whole object. The map then holds
/// (1 + c) D / (D + F + c) as in sampledTransform(), with D by the method of the options and F by sampling.
/// \throws std::invalid_argument for bad options.
SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options = {}, const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
