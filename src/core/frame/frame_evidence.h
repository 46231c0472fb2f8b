#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/plane_profiles.h"
#include "core/frame/surface_directions.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// Samples of the profiles that scores come from. chosen: D within about 1 %; half raises the error by a factor of
/// sqrt(2), twice takes twice the time.
constexpr int kNumProfileSamples = 256;

/// \return those of the distance transform; sigma is 0 where the width is not given.
GaussianEdtOptions edtOptionsOf(const FrameOptions& options);

/// The coarse map over all planes that candidates for the first plane come from (Section 4.3).
/// \param free_space from freeSpace(), one value per cell; empty: the points show the object from all sides.
SymmetryMap coarseMap(const GaussianEdt& edt, const std::vector<float>& free_space, const FrameOptions& options);

/// The offset of a plane of some normal, and its score.
struct ScoredOffset {
  float offset = 0.0f;  ///< cells from the middle of the grid
  float score = 0.0f;
};

/// What the points say about planes of a frame (Section 5.1).
///
/// The score of a plane is D, or seenSymmetry() of D and free space for a scan. Departures from the paper: free space
/// counts, and the surface has a say: of nearly equal planes the one that the faces of the surface agree with is
/// better. Offsets and places are in cells from the middle of the grid, unless they are called input.
class FrameEvidence {
public:
  /// \param points 3 x N, finite, input units; must outlive this object.
  /// \param visibility what the scanner saw; null = the points show the object from all sides.
  FrameEvidence(const PointsRef& points, const FrameOptions& options, const Visibility* visibility);

  const PointsRef& points() const { return points_; }
  bool scanned() const { return scanned_; }
  const GaussianEdt& edt() const { return edt_; }
  const std::vector<float>& freeSpace() const { return free_space_; }
  const SurfaceDirections& directions() const { return directions_; }
  const PrincipalAxes& principalAxes() const { return principal_axes_; }  ///< of the points, input frame
  const Eigen::Vector3f& centerOfMass() const { return center_of_mass_; }
  float reach() const { return reach_; }  ///< radius of the grid, cells

  Eigen::Vector3f toCells(const Eigen::Vector3d& x) const { return ((x - middle_) / edt_.cellSize()).cast<float>(); }
  Eigen::Vector3d toInput(const Eigen::Vector3f& x) const { return middle_ + edt_.cellSize() * x.cast<double>(); }
  CellPlane toCells(const ReflectionPlane& plane) const;

  float score(const CellPlane& plane) const { return profiles_.score(plane); }
  /// Weighted agreement of the surface with an axis.
  double agreement(const Eigen::Vector3f& axis) const { return weights_.agreement * directions_.agreement(axis); }
  /// By which candidates for the first plane are compared.
  double quality(const CellPlane& plane) const { return score(plane) + agreement(plane.normal); }
  /// By which frames are compared: the score of the first plane, a share of those of the others, and agreement.
  /// \param scores of the first, second and third plane.
  /// \param agreement sum of agreement() of the three axes.
  double value(const Eigen::Vector3f& scores, double agreement) const {
    return scores[0] + weights_.others * (scores[1] + scores[2]) + agreement;
  }

  /// The cloud that planes perpendicular to \p first are judged on: a scan is completed across the first plane.
  /// \return what the functions below take as \p completed_across.
  const CellPlane* completedAcross(const CellPlane& first) const { return scanned_ ? &first : nullptr; }

  /// Scores at all offsets in steps of a cell, the first at -floor(reach()).
  std::vector<float> profile(const Eigen::Vector3f& normal, const CellPlane* completed_across) const;
  /// The best offset of profile().
  ScoredOffset bestOffset(const Eigen::Vector3f& normal, const CellPlane* completed_across = nullptr) const;
  /// The best offset within 1.5 cells of \p offset, in steps of half a cell.
  ScoredOffset nearbyOffset(const Eigen::Vector3f& normal, float offset,
                            const CellPlane* completed_across = nullptr) const;

  /// Variance of the points along an axis, input units squared.
  double spreadAlong(const Eigen::Vector3f& axis) const;
  /// Middle of the extent of the points along an axis, cells. For a scan it lies near that of the whole object, because
  /// silhouettes and rims are seen where surfaces behind them are not; the center of mass does not. It is pushed away
  /// from the scanner, because the extent ends where the back begins.
  double middleAlong(const Eigen::Vector3f& axis) const;

private:
  /// Shares of the second and third plane and of agreement in the value of a frame. Both break ties, as between the
  /// planes across the faces and across the edges of a box with square sides.
  struct Weights {
    double others, agreement;
  };
  static Weights weightsOf(bool scanned);
  /// What the middle of a scan's extent is pushed by, cells; 0 for whole clouds.
  Eigen::Vector3f push(const Visibility* visibility) const;
  static GaussianEdtOptions edtOptions(const PointsRef& points, GaussianEdtOptions options, bool scanned);

  const PointsRef& points_;
  const bool scanned_;
  const Weights weights_;
  const GaussianEdt edt_;
  const std::vector<float> free_space_;
  const PlaneProfiles profiles_;
  const SurfaceDirections directions_;
  const Eigen::Vector3d middle_;  // middle of the grid, input frame
  const float reach_;
  const PrincipalAxes principal_axes_;
  const Eigen::Vector3f center_of_mass_;
  const Eigen::Vector3f push_;
};

}  // namespace pcl_symmetry
