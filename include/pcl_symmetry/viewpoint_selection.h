#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/viewpoint_score.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A direction to look at an object from, and a camera there.
struct SelectedView : RankedView {
  /// Maps camera coordinates (x right, y down, z forward) to the frame of the input, as
  /// pcl::visualization::PCLVisualizer::getViewerPose() does: with p, y and z the translation and the second and third
  /// column, setCameraPosition(p, p + z, -y) looks from there. The camera sees the whole object at an angle of view of
  /// 25 degrees.
  Eigen::Affine3f pose = Eigen::Affine3f::Identity();
};

/// Selects good and bad views of an object by the symmetries that they show (Section 5.4 of the paper).
///
/// S(v) = sum M |v . n| over the planes of local maxima; the best view has the greatest S. Views that differ only in
/// the signs of v . n can have equal S: of a view and its opposite, the one from above is taken, and of nearby views
/// within 2 % of each other, the one that hides the fewest points.
///
/// \code
/// pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
/// refinement.setInputCloud(cloud);
/// refinement.setApproximate(true);  // all local maxima, not only the symmetries of the whole object
/// pcl_symmetry::ViewpointSelection selection;
/// const std::vector<pcl_symmetry::SymmetryPlane> planes = refinement.compute();
/// selection.setPlanes(planes, refinement.getAxes(), findLocalMaxima(refinement.getSymmetryMap()));
/// selection.setInputCloud(cloud);
/// const Eigen::Affine3f camera = selection.getBestView().pose;
/// \endcode
class ViewpointSelection {
public:
  /// Sets the planes of S, weighted by their score. An axis counts as a fan of planes with the weight of two planes.
  /// \param planes planes of SymmetryMaximaRefinement with setApproximate(true).
  /// \param maxima maxima of the map. As long as some direction scores less than a fifth of the best one, the strongest
  /// maximum whose normal is more than 60 degrees from all planes so far is added. (Refinement drops maxima that are no
  /// symmetry of any part, but without the weak maximum of the plane perpendicular to its axis, a mug would be best
  /// seen level from the side.)
  void setPlanes(const std::vector<SymmetryPlane>& planes, const std::vector<SymmetryAxis>& axes = {},
                 const std::vector<LocalMaximum>& maxima = {});

  /// Sets the object: its size gives the distance of the cameras, and views may hide some of its points.
  /// \param cloud points that are not finite are left out. If it is null or has no extent, views are empty.
  void setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud);

  /// Sets the approximate up direction. Cameras stand upright along the nearest principal symmetry axis: the normal of
  /// the strongest plane, or of a plane perpendicular to it.
  /// \param up input frame, finite, of any length but zero; default z.
  /// \throws pcl::BadArgumentException for other values.
  void setUp(const Eigen::Vector3d& up);

  /// \param separation least angle between good views, radians, in [0, pi]; default 0.7 (40 degrees).
  /// \throws pcl::BadArgumentException for other values.
  void setSeparation(double separation);

  /// \return the view of the greatest S. If the cloud has no extent: score 0 at direction 0, and PCL_WARN says so.
  SelectedView getBestView() const;
  /// \return the view along the symmetries, which shows the least of the object; without extent as in getBestView().
  SelectedView getWorstView() const;
  /// Lists good views that differ.
  /// \param num_views >= 1.
  /// \return at most \p num_views local maxima of S, by decreasing S; of equal ones, first the one that hides the
  /// fewest points. They keep the separation from each other and from each other's reflections in the symmetries of the
  /// whole object, which would show the same again. Empty if the cloud has no extent, and PCL_WARN says so.
  /// \throws pcl::BadArgumentException if \p num_views is less than 1.
  std::vector<SelectedView> getGoodViews(int num_views) const;

  /// The pose of a camera that looks from a direction.
  /// \param direction from the object to the camera, finite, of any length but zero.
  /// \return the pose of a camera that sees the whole object from this direction, see SelectedView::pose.
  /// \throws pcl::BadArgumentException for other directions.
  Eigen::Affine3f computePose(const Eigen::Vector3d& direction) const;

  /// The score of a view.
  /// \param direction unit.
  /// \return S(direction), see Figure 16 of the paper.
  double getScore(const Eigen::Vector3d& direction) const { return viewpointScore(planes_, direction); }
  /// \return the principal symmetry axis that cameras stand upright along, unit.
  Eigen::Vector3d getUpAxis() const;

private:
  /// \return whether the cloud has an extent. Prints a warning where it has none.
  bool hasExtent() const;
  /// The view that hides the fewest points, of those from above where there are any.
  RankedView leastHidden(const std::vector<RankedView>& views) const;

  std::vector<ViewPlane> planes_;
  std::vector<Eigen::Vector3d> symmetries_;  // normals of the planes that are symmetries of the whole object
  Points points_ = Points(3, 0);
  BoundingBall ball_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  double separation_ = 0.7;  // radians
};

}  // namespace pcl_symmetry
