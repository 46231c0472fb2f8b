#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/transform_axes/axial_transform.h"

namespace pcl_symmetry {

/// What a scan says of one turn about a line, shares of the points seen. The rest lands where nothing was seen.
struct TurnShares {
  double on = 0.0;   ///< lands within the tolerance of the surface seen
  double off = 0.0;  ///< lands where the scanner saw that there is nothing, beyond the tolerance
  double far = 0.0;  ///< the same, beyond ten tolerances: a handle, not a dent
};

/// Judges turns by what a scanner saw: the surface, and the space in front of it. Beyond the paper (Section 6).
class TurnEvidence {
public:
  /// \param cloud of a scan; must outlive this.
  /// \param tolerance normalised frame.
  TurnEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed);

  /// By distances that the EDT tells, of a few points: for screening.
  /// \param slack tolerances.
  /// \param most_off,most_far shares beyond which the rest of the points is left out.
  TurnShares roughly(const Line3d& line, double angle, double slack, double most_off, double most_far) const;

  /// By distances from the surface.
  TurnShares exactly(const Line3d& line, double angle) const;

  /// The line moved to where some turns about it map the points seen onto each other best: point to plane, with
  /// weights that fall with the distance. Matches at borders do not count, as the true one may not have been seen.
  Line3d refined(const Line3d& line, const std::vector<double>& angles) const;

  const NormalizedCloud& cloud() const { return cloud_; }

private:
  bool isSeenEmpty(const Eigen::Vector3d& x) const;

  const NormalizedCloud& cloud_;
  double tolerance_;
  Eigen::Vector3d viewpoint_;  ///< normalised frame
  double far_, reach_;         ///< distance of what is far, and of points whose discs all are
  std::vector<int> samples_, few_samples_;
};

}  // namespace pcl_symmetry
