#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/base/small_motion.h"
#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/pose_search.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

/// Least squares in a small motion (rotation vector, translation).
class MotionEquations {
public:
  /// \param unit unit of the lengths, > 0, in which rotations and translations have equal weight.
  explicit MotionEquations(double unit) : unit_(unit) {}

  /// Adds w (n . (x + rotation x x + translation) - n . y)^2.
  void addPlane(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& n, double weight) {
    of_planes_.add(x.cross(n) / unit_, n, n.dot(y - x) / unit_, weight);
  }

  /// Adds w |x + rotation x x + translation - y|^2, the sum of addPlane() over three perpendicular normals.
  void addPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    of_points_.add(x / unit_, (y - x) / unit_, 1.0, weight);
  }

  /// The least-squares motion, without motion along unconstrained directions.
  Eigen::Isometry3d motion() const;

private:
  double unit_;
  WeightedProducts of_planes_;  // rows of lever, normal and distance
  WeightedProducts of_points_;  // rows of arm, displacement and 1
};

/// Scores and improves poses that align a scan or a whole object with a model of it (Section 5.1).
///
/// Every point of the scan has to lie on the model, unless the model is a scan too and could not see that position. No
/// point of the model may lie in free space of the scan. Both are counted with a Gaussian of the distance, so that the
/// score rises on the way from a coarse pose to the exact one.
class PoseScorer {
public:
  /// Level of detail.
  struct Detail {
    int num_points;      ///< points of each cloud, >= 1
    double width;        ///< width of the Gaussian, in the unit of the clouds, > 0
    bool exact = false;  ///< takes closest points from the tree, not from the grid
    /// Measures distances from the surface between the points of the model, without normals, so that the density of the
    /// model and the noise of the scan do not matter. Otherwise distances from its points are measured, with less
    /// support where normals differ.
    bool from_surface = false;
    /// Size of the model, in the unit of the clouds, > 0: in this unit, rotations and translations have equal weight.
    double unit = 1.0;
  };

  /// \param scan,model must outlive this object.
  PoseScorer(const PosedSurface& scan, const PosedSurface& model) : scan_(scan), model_(model) {}

  PoseScore score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

  /// One Gauss-Newton step. It reduces two kinds of distances: of the scan's points from the tangent planes at their
  /// closest points, weighted by the Gaussian, and of the model's points in free space from the scan.
  Eigen::Isometry3d step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

private:
  const PosedSurface& scan_;
  const PosedSurface& model_;
};

/// Steps with a Gaussian whose width decreases geometrically.
struct PoseImprovement {
  int num_steps, num_points;
  double first_width, last_width;  ///< radii
};

struct RankedPose {
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
  PoseScore score;
  int num_points = 0;  ///< points of the scan that the pose was fitted to; 0 = it was not fitted

  /// \param unit radius of the model, in the unit of the pose.
  void improve(const PoseScorer& scorer, const PoseImprovement& how, double unit = 1.0);
};

/// The first poses, at most \p max_count, that differ from all earlier ones.
/// \param radius radius of the model, in the unit of the poses.
std::vector<RankedPose> firstDistinct(const std::vector<RankedPose>& poses, std::size_t max_count, double radius = 1.0);

/// The poses of greatest merit, at most \p max_count, that differ from all better ones.
std::vector<RankedPose> distinctPoses(std::vector<RankedPose> poses,
                                      std::size_t max_count = std::numeric_limits<std::size_t>::max(),
                                      double radius = 1.0);

/// A few distinct poses of greatest merit (Section 5.1). Evenly spread rotations are screened by merit. The best of
/// these and all hypotheses are improved coarsely, and the best results finely, by Gauss-Newton steps with a narrowing
/// Gaussian.
/// \param scan,model each about its own center, in units of the model's radius.
/// \param hypotheses T_model_scan to improve in addition to the screened ones, such as those that align frames.
/// \return best first.
/// \throws std::invalid_argument for bad options.
std::vector<RankedPose> searchPoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<Eigen::Isometry3d>& hypotheses,
                                    const PoseSearchOptions& options = {});

/// Rotations spread evenly over all rotations (super-Fibonacci spirals, Alexa 2022).
/// \param num_rotations n >= 0.
/// \return n rotations; every rotation is within about 160 / cbrt(n) degrees of one of them.
std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations);

/// Completes rotations to poses: the translation puts a rotated scan where the model would look like it to the scanner.
///
/// As seen by the scanner, the middle of the scan's outline is put on the middle of the model's, and the front of the
/// scan on the front of the model. Without a viewpoint, the centers of mass are aligned.
class PoseStarts {
public:
  PoseStarts(const PosedSurface& scan, const PosedSurface& model);

  Eigen::Isometry3d pose(const Eigen::Matrix3d& R_model_scan) const;

private:
  bool from_outline_;
  Eigen::Matrix3Xd model_;
  Eigen::Matrix3d R_scanner_scan_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scan_anchor_, model_anchor_ = Eigen::Vector3d::Zero();
};

/// The poses that align the symmetry frame of one cloud with that of another, in all ways that symmetry allows (Section
/// 5.1).
///
/// The axes of \p b may have any order and any signs that form a rotation: 24 ways for every equally good frame of \p a
/// that is a maximum. About an axis of revolution of \p a, the poses differ by steps of 45 degrees: between a scan and
/// a whole object, the handle of a mug may be hidden.
/// \param a,b frames of two clouds, each in its own input frame.
/// \return T_b_a; poses whose rotation is within 10 degrees of an earlier one are left out.
std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b);

}  // namespace pcl_symmetry
