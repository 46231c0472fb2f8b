#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "pcl_symmetry/core/line_transform.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The planar case of the transform (Section 4.2): the symmetry of points that lie in a plane, such as a contour or the
/// pixels of a picture, with respect to every line in that plane.
///
/// The sheet that the points lie in is found from the data: points with equal z keep their x and y; all others are
/// projected onto the plane of their first two principal axes.
///
/// \code
/// pcl_symmetry::PlanarSymmetryTransform2D<pcl::PointXYZ> transform;
/// transform.setInputCloud(contour);
/// transform.compute();
/// for (const pcl_symmetry::LineMaximum& maximum : transform.getLines())
///   std::cout << transform.getPlane(maximum.line).coefficients().transpose() << " " << maximum.value << "\n";
/// \endcode
template <typename PointT>
class PlanarSymmetryTransform2D : public CloudAnalysis<PointT> {
public:
  using Ptr = pcl::shared_ptr<PlanarSymmetryTransform2D<PointT>>;
  using ConstPtr = pcl::shared_ptr<const PlanarSymmetryTransform2D<PointT>>;

  /// Uses at most 200 000 points, see setMaxPoints().
  PlanarSymmetryTransform2D() : CloudAnalysis<PointT>("PlanarSymmetryTransform2D", 200'000) {}

  /// \param n cells of the distance transform along each side, and bins of theta and of r, in [8, 4096]; default 128.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as all setters here.
  void setGridSize(int n) {
    detail::changeOptions(edt_options_, [&](GaussianEdt2DOptions& changed) { changed.num_cells = n; });
  }
  /// \param sigma width of the Gaussian, input units, >= 0; 0 (default) = two cells, or the spacing of the points where
  /// that is more.
  void setSigma(double sigma) {
    detail::changeOptions(edt_options_, [&](GaussianEdt2DOptions& changed) { changed.sigma = sigma; });
  }
  /// \param num_threads >= 0; 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads) {
    detail::checkAtLeast("num_threads", num_threads, 0);
    num_threads_ = num_threads;
  }

  /// \return the map, in the coordinates of the sheet; empty where the input holds no answer, see getReason().
  LineMap compute();

  /// \return the local maxima of the last map, refined, strongest first, in the coordinates of the sheet.
  const std::vector<LineMaximum>& getLines() const { return lines_; }
  /// \return the pose of the last sheet: takes points (x, y, 0) of the sheet to the frame of the input.
  const Eigen::Isometry3d& getSheetPose() const { return sheet_.T_input_sheet; }
  /// \param line in the coordinates of the last sheet.
  /// \return the plane across the sheet that contains the line, input frame: it reflects the points as the line does.
  ReflectionPlane getPlane(const ReflectionLine& line) const {
    const ReflectionPlane across(Eigen::Vector3d(line.normal().x(), line.normal().y(), 0.0), line.offset());
    return across.transformed(sheet_.T_input_sheet).canonical();
  }
  /// \return the points that the last compute() used, in the coordinates of the sheet.
  const Points2D& getSheetPoints() const { return sheet_.points; }
  /// \return the function f that the last map was made from; null without one.
  std::shared_ptr<const GaussianEdt2D> getDistanceTransform() const { return edt_; }

protected:
  void clearResults() override {
    CloudAnalysis<PointT>::clearResults();
    sheet_ = {};
    edt_.reset();
    lines_.clear();
  }

private:
  GaussianEdt2DOptions edt_options_;
  int num_threads_ = 0;
  Sheet sheet_;
  std::shared_ptr<const GaussianEdt2D> edt_;
  std::vector<LineMaximum> lines_;
};

template <typename PointT>
LineMap PlanarSymmetryTransform2D<PointT>::compute() {
  return detail::withBadArguments([&] {
    constexpr std::uint64_t kSeed = 1;  // any other draws other points of a larger cloud
    const Points points = this->selectInput(kSeed);
    if (points.cols() == 0) return LineMap();
    sheet_ = flattened(points);
    edt_ = std::make_shared<const GaussianEdt2D>(sheet_.points, edt_options_);
    const LineGrid grid(edt_options_.num_cells, edt_options_.num_cells, edt_->center(), edt_->radius());
    const Eigen::Vector2d center_of_mass = sheet_.points.template cast<double>().rowwise().mean();
    LineMap map = lineTransform(*edt_, grid, center_of_mass, num_threads_);
    lines_ = findLineMaxima(*edt_, map, {}, num_threads_);
    return map;
  });
}

}  // namespace pcl_symmetry
