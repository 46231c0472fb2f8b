#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/detection/detection_rules.h"
#include "core/detection/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// The least margin to a limit, >= 0 where all are kept: by it the orders of a line and the lines are compared. What is
/// reported is turnConfidence(), which is fitted to lines that were chosen so.
/// \param turn with the shares that were seen.
inline double marginOf(const SymmetryTurn& turn) {
  const double least_on = turn.fold == 0   ? kDetection.rotations.round_on
                          : turn.fold == 2 ? kDetection.rotations.half_turn_on
                                           : kDetection.rotations.fold_on;
  const double most_off = turn.fold == 0 ? kDetection.rotations.most_round_off : kDetection.rotations.most_off,
               most_far = turn.fold == 0 ? kDetection.rotations.most_round_far : kDetection.rotations.most_far;
  const double margin = std::min({1.0 - turn.off / most_off, 1.0 - turn.far / most_far, turn.support / least_on - 1.0});
  return turn.fold == 0 ? margin
                        : std::min(margin, (turn.halfway - turn.off) / kDetection.rotations.halfway_more - 1.0);
}

/// What a scan tells about one rotation about a line, shares of the points seen. The rest lands where nothing was seen.
struct TurnShares {
  double on = 0.0;   ///< lands within the tolerance of the surface seen
  double off = 0.0;  ///< lands where the scanner saw that there is nothing, beyond the tolerance
  double far = 0.0;  ///< the same, beyond ten tolerances: a handle, not a dent
};

/// The rotation about a line by an angle in radians.
Eigen::Isometry3d turnAbout(const Line3d& line, double angle);

/// Judges rotations by what a scanner saw: the surface, and the space in front of it. Beyond the paper (Section 6).
class TurnEvidence {
public:
  /// \param cloud of a scan; must outlive this.
  /// \param tolerance normalized frame.
  TurnEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed);

  /// By distances that the EDT tells, of a few points: for screening.
  /// \param slack tolerances.
  /// \param most_off,most_far shares beyond which the rest of the points is left out.
  TurnShares roughly(const Eigen::Affine3d& motion, double slack, double most_off, double most_far) const;

  /// By distances from the surface.
  TurnShares exactly(const Eigen::Affine3d& motion) const;

  /// How fast the match of a rotation is lost as the line moves: second smallest eigenvalue of its stiffness, point to
  /// plane, under two tilts and two shifts; mean over the points, radii. The smallest is small for all that slides.
  double hold(const Line3d& line, double angle) const;

  /// The line moved to where some rotations about it map the points seen onto each other best: point to plane, with
  /// weights that fall with the distance and the angle between the normals. A side that faces away from the scanner
  /// matches nothing that was seen. Matches at borders do not count, as the true one may not have been seen, unless
  /// the point lands where the scanner saw nothing: the border then pulls it back.
  Line3d refined(const Line3d& line, const std::vector<double>& angles) const;

  /// The same from a line that is nearly right, with more points and less wide weights.
  Line3d closelyRefined(const Line3d& line, const std::vector<double>& angles) const;

  const NormalizedCloud& cloud() const { return cloud_; }

private:
  /// Normal equations of a small motion of a line: two tilts and two shifts.
  struct Pulls {
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  };

  /// Points that a motion moved, and what they are near to.
  struct Moved {
    Points points;
    std::vector<int> closest;      ///< -1: nothing within the reach
    std::vector<float> distances;  ///< from the surface
  };

  Moved moved(const Eigen::Affine3d& motion) const;
  /// \param width of the weights, tolerances.
  /// \param[in,out] closest points to the moved samples, of a line nearby; -1 where none is known.
  void addPulls(const Line3d& line, double angle, const std::vector<int>& samples, double width,
                std::vector<int>& closest, Pulls& pulls) const;
  Line3d fitted(const Line3d& start, const std::vector<double>& angles, const std::vector<int>& samples,
                const std::array<double, 6>& widths) const;
  bool isSeenEmpty(const Eigen::Vector3d& x) const;

  const NormalizedCloud& cloud_;
  double tolerance_;
  Eigen::Vector3d viewpoint_;  ///< normalized frame
  double far_, reach_;         ///< distance of what is far, and of points whose discs all are
  std::vector<int> samples_, few_samples_;
  Points facing_;  ///< normals, toward the scanner
};

}  // namespace pcl_symmetry
