#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/detection/plane_detection.h"
#include "pcl_symmetry/core/viewpoint/viewpoint_score.h"

namespace pcl_symmetry {

/// A direction to look at an object from, and a camera there.
struct SelectedView : RankedView {
  /// Takes camera coordinates (x right, y down, z forward) to the frame of the input, as
  /// pcl::visualization::PCLVisualizer::getViewerPose() has it: with p, y and z its translation, second and third
  /// column, setCameraPosition(p, p + z, -y) looks from there. The camera sees the whole object at 25 degrees.
  Eigen::Affine3f pose = Eigen::Affine3f::Identity();
};

/// Good and bad views of an object, by the symmetries that they show (Section 5.4).
///
/// S(v) = sum M |v . n| over the planes of local maxima; the best view has the greatest S. Views that differ in the
/// signs of v . n only can have equal S: among those within 2 % of the best, the one from above is taken that hides
/// fewest points.
///
/// \code
/// pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
/// refinement.setInputCloud(cloud);
/// refinement.setApproximate(true);  // all local maxima, not only the symmetries of the whole
/// pcl_symmetry::ViewpointSelection selection;
/// const std::vector<pcl_symmetry::SymmetryPlane> planes = refinement.compute();
/// selection.setPlanes(planes, refinement.getAxes(), findLocalMaxima(refinement.getSymmetryMap()));
/// selection.setInputCloud(cloud);
/// const Eigen::Affine3f camera = selection.getBestView().pose;
/// \endcode
class ViewpointSelection {
public:
  /// The local maxima of the transform, weighted by their score. An axis counts as a fan of planes that weighs as much
  /// as two. \param planes of SymmetryMaximaRefinement, with setApproximate(true). \param maxima of the map: as long as
  /// some direction has less than a fifth of the best score, the strongest one whose normal is more than 60 degrees
  /// from all planes so far counts too. Refinement drops maxima that are no symmetry of any part, but a mug without the
  /// weak one across its axis would be best seen level from the side.
  void setPlanes(const std::vector<SymmetryPlane>& planes, const std::vector<SymmetryAxis>& axes = {},
                 const std::vector<LocalMaximum>& maxima = {});

  /// The object, for the distance of the cameras and for what a view hides; points that are not finite are left out.
  void setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud);

  /// About where up is, input frame, any length but zero; default z. Cameras stand upright along the principal symmetry
  /// axis (the normal of the strongest plane, or of one across it) that is nearest to it.
  void setUp(const Eigen::Vector3d& up);

  /// Angle that good views keep from each other, radians, in [0, pi]; default 40 degrees.
  void setSeparation(double separation);

  /// \throws pcl::BadArgumentException without a finite point.
  SelectedView getBestView() const;
  /// The view along the symmetries, which shows the least of the object. \throws as getBestView().
  SelectedView getWorstView() const;
  /// At most \p num_views local maxima of S, best first, apart from each other and from each other's mirror images in
  /// the symmetries of the whole, which would show the same again. \throws as getBestView().
  std::vector<SelectedView> getGoodViews(int num_views) const;

  /// A camera that sees the whole object from this direction. \param direction not zero. \throws as getBestView().
  Eigen::Affine3f computePose(const Eigen::Vector3d& direction) const;

  /// S at any direction (Figure 16). \param direction unit.
  double getScore(const Eigen::Vector3d& direction) const { return viewpointScore(planes_, direction); }
  /// The principal symmetry axis that cameras stand upright along, unit.
  Eigen::Vector3d getUpAxis() const;

private:
  /// The direction of least hidden points, of those from above where there are any.
  RankedView leastHidden(const std::vector<RankedView>& views) const;

  std::vector<ViewPlane> planes_;
  std::vector<Eigen::Vector3d> symmetries_;  // normals of the planes that are symmetries of the whole
  Points points_;
  BoundingBall ball_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  double separation_ = 0.7;
};

}  // namespace pcl_symmetry
