#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Bins of theta, of phi and of r, and cells along each side of the distance transform.
constexpr int kDescriptorBins = 32;
constexpr int kPRSTSize = kDescriptorBins * kDescriptorBins * kDescriptorBins;  // theta x phi x r
constexpr int kPRSDSize = kDescriptorBins * kDescriptorBins;                    // theta x phi
constexpr int kGEDTSize = kPRSTSize;                                            // cells x cells x cells

struct DescriptorOptions {
  int num_samples = 256;  ///< samples of the transform, >= 1
  /// Whether PRST and PRSD are sqrt((1 + D) / 2) as in Equation 1, instead of sqrt(max(D, 0)).
  bool by_equation_1 = false;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The descriptors that the paper compares (Section 5.2), of one shape in one frame.
struct SymmetryDescriptors {
  /// Planar reflective symmetry transform at the centers of the bins (theta, phi, r), r fastest.
  ///
  /// Departure from the paper: the values are sqrt(max(D, 0)) instead of PRST = sqrt((1 + D) / 2) of Equation 1. f is
  /// nowhere negative, so that Equation 1 maps all planes to [0.71, 1]; the root of D uses [0, 1] and is 0 for planes
  /// without any symmetry. Both increase with D; DescriptorOptions::by_equation_1 selects one of them.
  std::vector<float> prst;
  /// PRSD, the reflective symmetry descriptor of Kazhdan et al. (2004): the same values for the planes through the
  /// origin, (theta, phi), phi fastest.
  std::vector<float> prsd;
  /// GEDT, the Gaussian Euclidean distance transform f (Section 4.1) at the centers of its cells, x fastest.
  std::vector<float> gedt;
};

class Visibility;

/// The frame that descriptors of a shape are computed in: its canonical frame, or \p input_axes about the center of
/// mass.
/// \param seen what a scanner saw; null = the points show the object from all sides.
Eigen::Isometry3d descriptorFrame(const PointsRef& points, bool input_axes, const Visibility* seen,
                                  const DescriptorOptions& options);

/// \param points 3 x N, finite, input units, not all at the origin of the frame.
/// \param T_frame_input from the input to the frame of the descriptors: a canonical frame, or the axes of the input
/// about the center of mass.
/// \throws std::invalid_argument for bad options or points without extent.
SymmetryDescriptors symmetryDescriptors(const PointsRef& points, const Eigen::Isometry3d& T_frame_input,
                                        const DescriptorOptions& options = {});

/// Sum of squared differences.
float sqDistance(const float* a, const float* b, std::size_t size);

/// L2 distance of two PRST or two PRSD descriptors, differences weighted by sqrt(sin theta), the size of the bins
/// (Section 5.2).
///
/// Departure from the paper: for PRSD, Kazhdan et al. (2004) take the maximum difference; L2 compares both descriptors
/// alike.
/// \param size kPRSTSize or kPRSDSize.
/// \throws std::invalid_argument for a size that is no multiple of kDescriptorBins.
float planeDescriptorDistance(const float* a, const float* b, std::size_t size);

}  // namespace pcl_symmetry
