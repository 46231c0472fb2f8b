#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

struct FrameOptions {
  GaussianEdtOptions edt;  ///< sigma = 0: two cells, three for what a scanner saw
  int num_theta = 32;      ///< of the map that candidates come from, >= 1
  int num_phi = 128;       ///< even, >= 2
  int num_radius = 64;     ///< >= 1
  int num_samples = 64;    ///< of the sampled transform, >= 1
  /// Frames whose scores are this close to those of the best are equally good, >= 0.
  double tie = 0.03;
  /// The paper's own method: greedily by D alone, the planes through bin centers of the map (num_theta, num_phi,
  /// num_radius) and, within the plane across the first axis, at as many angles.
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
  Eigen::Vector3d scores = Eigen::Vector3d::Zero();    ///< of the plane across each axis, in [0, 1]
  int revolution_axis = -1;  ///< column that is an axis of revolution; -1: none, 3: every line through the center is
  Eigen::Isometry3d T_canonical_input = Eigen::Isometry3d::Identity();  ///< center to 0, axes to x, y, z
  /// T_canonical_input of all frames that symmetry leaves equally good, this one first. A plane has no sign: every
  /// choice of signs that is a rotation is here; where scores tie, other orders and other axes too. About an axis of
  /// revolution any angle is as good, in addition.
  std::vector<Eigen::Isometry3d> equivalent;
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// The principal symmetry axes and the center of symmetry: the plane of greatest symmetry, the greatest among those
/// perpendicular to it, and the plane perpendicular to both; the center is where they meet.
///
/// Signs: along each axis the heavier tail, where the third moment of the points about the center is positive, comes
/// first for the second and third axis; the first is their cross product's. Where a shape is symmetric the moment
/// vanishes and the sign means nothing.
/// \param points 3 x N, finite, input units; at least two different ones.
/// \param visibility what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for bad options or points without extent.
SymmetryFrame symmetryFrame(const PointsRef& points, const FrameOptions& options = {},
                            const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
