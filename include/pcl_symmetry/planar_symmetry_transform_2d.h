#pragma once

#include <pcl/pcl_base.h>

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/transform_2d/line_transform.h"

namespace pcl_symmetry {

/// The planar case (Section 4.2): symmetry of points that lie in a plane, a contour or the pixels of a picture, with
/// respect to every line in it.
///
/// Honours setIndices; points that are not finite are left out. The sheet that the points lie in is found by itself:
/// z = constant keeps x and y, any other is the plane of the first two principal axes, onto which points are projected.
///
/// \code
/// pcl_symmetry::PlanarSymmetryTransform2D<pcl::PointXYZ> transform;
/// transform.setInputCloud(contour);
/// transform.compute();
/// for (const pcl_symmetry::LineMaximum& maximum : transform.getLines())
///   std::cout << transform.getPlane(maximum.line).coefficients().transpose() << " " << maximum.value << "\n";
/// \endcode
template <typename PointT>
class PlanarSymmetryTransform2D : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<PlanarSymmetryTransform2D<PointT>>;
  using ConstPtr = pcl::shared_ptr<const PlanarSymmetryTransform2D<PointT>>;

  /// Cells along each side of the distance transform, and bins of theta and of r, in [8, 4096]; default 128.
  void setGridSize(int n);
  /// Width of the Gaussian, input units, > 0; default two cells, or the spacing of the points where that is more.
  void setSigma(double sigma);
  /// Thresholds on the maxima that getLines() gives; default those of the paper.
  void setMaximaOptions(const LocalMaximaOptions& options);
  /// Of larger clouds so many points are drawn, >= 2; default 200 000.
  void setMaxPoints(std::size_t max_points);
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);

  /// \return the map, in the coordinates of the sheet.
  /// \throws pcl::BadArgumentException without input, or where the finite points have no extent.
  LineMap compute();

  /// Of the last compute(): local maxima of the map, refined, strongest first, in the coordinates of the sheet.
  const std::vector<LineMaximum>& getLines() const { return lines_; }
  /// Of the last compute(): takes points (x, y, 0) of the sheet to the frame of the input.
  const Eigen::Isometry3d& getSheetPose() const { return T_input_sheet_; }
  /// The plane across the sheet that holds the line: its reflection is that of the line. Input frame.
  ReflectionPlane getPlane(const ReflectionLine& line) const;
  /// Of the last compute(): the points used, in the coordinates of the sheet.
  const Points2D& getSheetPoints() const { return sheet_points_; }
  /// The function f that the last map was made from; null before compute().
  std::shared_ptr<const GaussianEdt2D> getDistanceTransform() const { return edt_; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

private:
  GaussianEdt2DOptions edt_options_;
  LocalMaximaOptions maxima_;
  std::size_t max_points_ = 200'000;
  int num_threads_ = 0;
  Eigen::Isometry3d T_input_sheet_ = Eigen::Isometry3d::Identity();
  Points2D sheet_points_;
  std::shared_ptr<const GaussianEdt2D> edt_;
  std::vector<LineMaximum> lines_;
};

}  // namespace pcl_symmetry
