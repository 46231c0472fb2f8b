#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/frame_rules.h"
#include "core/frame/plane_profiles.h"
#include "core/geometry/cloud_extent.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

/// The directions that the surface of a shape faces: one normal for each cell of a coarse grid that the surface passes.
class SurfaceDirections {
public:
  /// \param points 3 x N, finite, input units.
  /// \param edt distance transform of the points: its cube is cut into half as many cells along each side.
  SurfaceDirections(const PointsRef& points, const GaussianEdt& edt);

  /// How well the surface agrees with an axis: the mean over the cells of a weight that is 1 where the normal is
  /// parallel or perpendicular to the axis, and falls to 0 within 6 degrees. A box agrees with its own axes everywhere.
  /// \param axis unit.
  /// \return in [0, 1].
  double agreement(const Eigen::Vector3f& axis) const;

  /// Directions that many normals share: the normals of the faces of a shape.
  /// \return unit directions, those shared by most of the surface first.
  std::vector<Eigen::Vector3f> peaks(int max_peaks) const;

private:
  Eigen::Matrix3Xf normals_;
  Eigen::ArrayX3f by_axis_;  // the normals, coordinate by coordinate
  Eigen::VectorXf weights_;  // sum to 1
};

/// The offset of a plane of a given normal, and its score.
struct ScoredOffset {
  float offset = 0.0f;  ///< cells from the middle of the grid
  float score = 0.0f;
};

/// Evidence of points for the planes of a frame (Section 5.1).
///
/// The score of a plane is D, or seenSymmetry() of D and free space for a scan. Offsets and positions are in cells from
/// the middle of the grid, unless their names say input. Departure from the paper: free space counts, and among nearly
/// equal planes the one that agrees with faces of the surface is better.
struct FrameEvidence {
  /// \param points 3 x N, finite, input units; must outlive this object.
  /// \param visibility what the scanner saw; null = the points show the object from all sides.
  FrameEvidence(const PointsRef& points, const FrameOptions& options, const Visibility* visibility);

  const PointsRef& points;
  const bool scanned;
  const double weight;  ///< weight of the second and third plane, and of agreement
  const GaussianEdt edt;
  const std::vector<float> free_space;
  const PlaneProfiles profiles;
  const SurfaceDirections directions;
  const Eigen::Matrix3Xd center_samples;  ///< samples of f of a whole cloud; cells from the center of cell (0, 0, 0)
  const Eigen::Vector3d middle;           ///< middle of the grid, input frame
  const float reach;                      ///< radius of the grid, cells
  const PrincipalAxes principal_axes;     ///< principal axes of the points, input frame
  const Eigen::Vector3f center_of_mass;
  const Eigen::Vector3f push;  ///< shift of the middle of a scan's extent, cells

  Eigen::Vector3f toCells(const Eigen::Vector3d& x) const { return ((x - middle) / edt.cellSize()).cast<float>(); }
  Eigen::Vector3d toInput(const Eigen::Vector3f& x) const { return middle + edt.cellSize() * x.cast<double>(); }
  CellPlane toCells(const ReflectionPlane& plane) const;

  float score(const CellPlane& plane) const { return profiles.score(plane); }
  /// Weighted agreement of the surface with an axis.
  double agreement(const Eigen::Vector3f& axis) const { return weight * directions.agreement(axis); }
  /// Criterion for candidates of the first plane.
  double quality(const CellPlane& plane) const { return score(plane) + agreement(plane.normal); }
  /// Criterion for frames: the score of the first plane, a share of the scores of the others, and agreement.
  /// \param scores scores of the first, second and third plane.
  double value(const Eigen::Vector3f& scores, double agreement) const {
    return scores[0] + weight * (scores[1] + scores[2]) + agreement;
  }

  /// The plane by whose reflection a cloud is completed to judge planes perpendicular to \p first: for scans, \p first
  /// itself.
  /// \return the argument \p completed_across of the functions below.
  const CellPlane* completedAcross(const CellPlane& first) const { return scanned ? &first : nullptr; }

  /// Scores at all offsets in steps of a cell, the first at offset -floor(reach).
  std::vector<float> profile(const Eigen::Vector3f& normal, const CellPlane* completed_across) const;
  /// The best offset of profile().
  ScoredOffset bestOffset(const Eigen::Vector3f& normal, const CellPlane* completed_across = nullptr) const;
  /// The best offset within 1.5 cells of \p offset, in steps of half a cell.
  ScoredOffset nearbyOffset(const Eigen::Vector3f& normal, float offset,
                            const CellPlane* completed_across = nullptr) const;

  /// Variance of the points along an axis, input units squared.
  double spreadAlong(const Eigen::Vector3f& axis) const;
  /// Middle of the extent of the points along an axis, cells. For a scan it lies near the middle of the whole object,
  /// unlike the center of mass, because silhouettes and rims are visible even where the surfaces behind them are not.
  /// It is pushed away from the scanner, because the extent ends where the back of the object begins.
  double middleAlong(const Eigen::Vector3f& axis) const;
};

}  // namespace pcl_symmetry
