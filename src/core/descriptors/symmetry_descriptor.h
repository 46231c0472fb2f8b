#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

/// Bins of theta, phi and r, and cells along each side of the distance transform.
constexpr int kDescriptorBins = 32;
constexpr int kPRSTSize = kDescriptorBins * kDescriptorBins * kDescriptorBins;
constexpr int kPRSDSize = kDescriptorBins * kDescriptorBins;
constexpr int kGEDTSize = kPRSTSize;

struct DescriptorOptions {
  double radius = 2.0;    ///< of the ball that is described, in mean distances of the points from the origin, > 0
  int num_samples = 256;  ///< of the sampled transform, >= 1
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The descriptors that the paper compares (Section 5.2), all of one shape in one frame.
struct SymmetryDescriptors {
  /// PRST = sqrt(max(D, 0)) at the centers of the bins, (theta, phi, r) with r fastest.
  std::vector<float> prst;
  /// The same of the planes through the origin, (theta, phi) with phi fastest: the reflective symmetry descriptor of
  /// Kazhdan et al. (2004).
  std::vector<float> prsd;
  /// f at the centers of the cells of the distance transform, x fastest.
  std::vector<float> gedt;
};

/// \param points 3 x N, finite, input units, not all at the origin of the frame.
/// \param T_frame_input to the frame that the descriptors are to have: origin and axes of a canonical frame, or the
/// input's own. \throws std::invalid_argument for bad options or points without extent.
SymmetryDescriptors symmetryDescriptors(const PointsRef& points, const Eigen::Isometry3d& T_frame_input,
                                        const DescriptorOptions& options = {});

/// Sum of squared differences; every loop gives the same bytes. \param a,b \p size values each.
float sqDistance(const float* a, const float* b, std::size_t size);

/// L2 distance of two PRST or PRSD descriptors, differences weighted by sqrt(sin theta), the size of the bins.
/// \param size kPRSTSize or kPRSDSize.
float planeDescriptorDistance(const float* a, const float* b, std::size_t size);

}  // namespace pcl_symmetry
