#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct FrameOptions {
  GaussianEdtOptions edt;  ///< sigma = 0: 1.5 cells, 2.25 for a scan, or 1.5 spacings of the points where that is more
  int num_theta = 32;      ///< of the map that candidates come from, >= 1
  int num_phi = 128;       ///< even, >= 2
  int num_radius = 64;     ///< >= 1
  int num_samples = 64;    ///< of the sampled transform, >= 1
  /// Scores, D of whole clouds, that differ by no more than this are equal, >= 0. The sampled D of a symmetry varies by
  /// 0.02 to 0.03 with the angle of the plane.
  double tie = 0.06;
  /// The paper's own method: greedily by D alone, through bin centers of the map and, within the plane across the first
  /// axis, at num_phi angles; what a scanner saw does not count, and nothing is tied.
  bool as_published = false;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Center of symmetry and principal symmetry axes of a shape: its canonical frame (Section 5.1).
struct SymmetryFrame {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();    ///< where the three planes meet, input frame
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: normals of the planes, right-handed, best first
  /// Of the plane across each axis, in [0, 1]: D, of a scan seenSymmetry() of D and free space; of the second and third
  /// plane of a scan as if it had been seen from both sides of the first.
  Eigen::Vector3d scores = Eigen::Vector3d::Zero();
  int revolution_axis = -1;  ///< column that is an axis of revolution; -1: none, 3: every line through the center is
  Eigen::Isometry3d T_canonical_input = Eigen::Isometry3d::Identity();  ///< center to 0, axes to x, y, z
  /// T_canonical_input of all frames that symmetry leaves equally good, this one first. A plane has no sign: every
  /// choice of signs that is a rotation is here; where scores tie, other orders and other axes too, first those that
  /// are maxima, then in steps of 6 degrees those between. About an axis of revolution any angle is as good, in
  /// addition.
  std::vector<Eigen::Isometry3d> equivalent;
  std::size_t num_maxima = 0;                             ///< how many of them come before those between
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// The plane of greatest symmetry, the greatest among those perpendicular to it, and the plane perpendicular to both;
/// the center is where they meet.
///
/// Departures from the paper: of two nearly equal planes the one that faces of the surface agree with is taken; the
/// second and third plane, often hardly symmetries at all, pass near the middle of the extent of the points.
/// Order: the first plane is the best of the frame that is best as a whole; the second scores more than the third or,
/// where they tie, the points spread more along it.
/// Signs: along the second and third axis the third central moment of the points is positive: they point to the side
/// where less of the shape reaches further. The first makes the frame right-handed, as it is the one most free of a
/// direction of its own. Along an axis of symmetry the moment vanishes and chance decides; a scan shows the moments of
/// the side that was seen. All signs are in SymmetryFrame::equivalent.
/// \param points 3 x N, finite, input units; at least two different ones.
/// \param visibility what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for bad options or points without extent.
SymmetryFrame symmetryFrame(const PointsRef& points, const FrameOptions& options = {},
                            const Visibility* visibility = nullptr);

/// For each frame (unit axes in columns) the greatest D of the planes across each of its axes, whatever their offset:
/// is another frame as symmetric as the one that was found? \param points as in symmetryFrame().
std::vector<Eigen::Vector3d> axisScores(const PointsRef& points, const std::vector<Eigen::Matrix3d>& frames,
                                        const FrameOptions& options = {});

}  // namespace pcl_symmetry
