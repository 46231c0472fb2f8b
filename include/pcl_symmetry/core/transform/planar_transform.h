#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/transform/symmetry_map.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Which inner loop runs; all give the same bytes.
enum class Simd { Auto, Scalar, Avx2, Avx512 };

/// \return whether this processor can run the loop.
bool simdSupported(Simd simd);

struct SampledTransformOptions {
  int num_samples = 128;  ///< points drawn for the whole map, >= 1; the error falls about as num_samples^-0.7
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core
  Simd simd = Simd::Auto;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Draws points x_i with probability f / S, stratified in space, once for the whole map, and looks up the other point
/// of each pair: D(gamma) = (S / |f|^2) mean f(gamma x_i).
///
/// Unlike pairs that vote (Section 4.3) it needs no weights, has no singularity at coincident points, and gives values
/// at bin centers. For one direction all radii of a sample lie on a straight line through the grid.
/// \param edt the function f. \param grid the planes, in the frame of the EDT.
/// \param free_space of a scan, see freeSpace(); empty: every point has been seen.
/// \return D at the bin centers; with free space, seenSymmetry() of D and of F, the same mean over the free space.
SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options = {},
                             const std::vector<float>& free_space = {});

struct ConvolutionTransformOptions {
  double spacing = 0.9;  ///< distance of the resampled lattice in sigmas, in (0, 1]; f is band-limited, see below
  int num_threads = 0;   ///< >= 0; 0 = one per core
  Simd simd = Simd::Auto;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The exact transform by convolution over plane translations (Section 4.2): for each direction n the volume is
/// resampled along n, and one correlation of each line with its reversal gives D for every r at once.
///
/// Departure from the paper: the lines are resampled at `spacing` sigmas and not at every cell. A Gaussian shell of
/// width sigma holds less than 1 % of its spectrum beyond the Nyquist frequency of that lattice, and PRST differs from
/// the full sum by 0.1 % root mean square at 64 cells a side (0.17 % for boxes, whose faces can lie along the lattice;
/// at 32 cells up to 0.3 %), at a tenth of the work: `spacing` 0.5 halves that. Lines are correlated directly, sixteen
/// at a time: they have about 36 values, where a Fourier transform does not pay. \return D at the bin centers.
SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options = {});

struct VotingTransformOptions {
  std::int64_t num_pairs = 2'000'000;  ///< point pairs drawn, >= 1; the paper's figure for 1 % at 64^3
  double near_distance = 4.0;  ///< cells, >= 0: closer pairs are drawn plane first, see below; 0 = the paper as written
  double near_share = 0.2;     ///< share of the pairs that are drawn plane first, in (0, 1)
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Monte Carlo voting (Section 4.3): draws pairs (x, x') with probability f(x) f(x') and votes for the plane between
/// them with weight 1 / (2 d^2 sin theta).
///
/// The weight has infinite variance as d -> 0. Departure from the paper: pairs closer than near_distance do not vote;
/// their share of the integral is drawn the other way round - x by f, a plane uniformly in (theta, phi, r) at less than
/// near_distance / 2 from x, with weight f(x') - where the same change of variables makes the weight bounded. The sum
/// of both is unbiased. \return averages of D over the bins.
SymmetryMap votingTransform(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options = {});

/// Which estimator, and the options of each.
struct PlanarTransformOptions {
  TransformMethod method = TransformMethod::Sampled;
  SampledTransformOptions sampled;
  ConvolutionTransformOptions convolution;
  VotingTransformOptions voting;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The planar-reflective symmetry transform of f by the method of the options.
/// \param grid the planes, in the frame of the EDT. \param center_of_mass of the points, in the same frame.
/// \param free_space of a scan, see freeSpace(): the map then holds seenSymmetry() of D, by the method of the options,
/// and of F, by sampling.
SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options = {}, const std::vector<float>& free_space = {});

}  // namespace pcl_symmetry
