#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

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

/// The same mean over the free space of a scan: F = (S / |f|^2) mean free(gamma x_i) at the bin centers, >= 0.
std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options = {});

/// Makes seenSymmetry(D, F) of every D in the map.
void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap);

}  // namespace pcl_symmetry
