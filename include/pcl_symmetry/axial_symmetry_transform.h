#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/axial_transform.h"
#include "pcl_symmetry/impl/transform_analysis.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The axial symmetry transform of a point cloud: a measure of its symmetry under rotations about every axis, and under
/// reflection in every point. It extends PlanarSymmetryTransform from reflections to rotations, which the paper leaves
/// to future work (Section 6).
///
/// The defaults need no tuning and suit any unit. A map has 16 x 64 directions with 32 x 32 offsets each; it takes
/// about three seconds on two cores, and 4 MiB per fold.
///
/// \code
/// pcl_symmetry::AxialSymmetryTransform<pcl::PointXYZ> transform;
/// transform.setInputCloud(cloud);
/// transform.compute();
/// for (const pcl_symmetry::AxisMaximum& maximum : transform.getAxes())
///   std::cout << maximum.axis.direction().transpose() << " fold " << maximum.fold << " " << maximum.value << "\n";
/// \endcode
template <typename PointT>
class AxialSymmetryTransform : public TransformAnalysis<PointT> {
public:
  using Ptr = pcl::shared_ptr<AxialSymmetryTransform<PointT>>;
  using ConstPtr = pcl::shared_ptr<const AxialSymmetryTransform<PointT>>;

  /// Uses at most 200 000 points, see setMaxPoints().
  AxialSymmetryTransform() : TransformAnalysis<PointT>("AxialSymmetryTransform") { edt_options_.num_cells = 32; }

  /// \param num_theta,num_phi,num_offset bins of the map, each >= 1, num_phi even; default 16, 64 and 32. The map has
  /// num_theta * num_phi * num_offset^2 axes.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as do all setters here.
  void setMapSize(int num_theta, int num_phi, int num_offset) {
    detail::withBadArguments([&] { AxisGrid(num_theta, num_phi, num_offset, Eigen::Vector3d::Zero(), 1.0); });
    num_theta_ = num_theta;
    num_phi_ = num_phi;
    num_offset_ = num_offset;
  }
  /// Sets folds, number of samples, seed and number of threads at once.
  void setOptions(const AxialTransformOptions& options) {
    detail::changeOptions(transform_, [&](AxialTransformOptions& changed) { changed = options; });
  }
  void setRandomSeed(std::uint64_t seed) { transform_.seed = seed; }  ///< Sets the seed of all random draws.
  /// \param num_threads >= 0; 0 = one per core (default).
  void setNumberOfThreads(int num_threads) {
    detail::changeOptions(transform_, [&](AxialTransformOptions& changed) { changed.num_threads = num_threads; });
  }

  /// \return the map of all axes, in the frame and units of the input; empty if the input holds no answer, see
  /// getReason(). With a viewpoint, its values are (1 + c) D / (D + F + c), as in PlanarSymmetryTransform.
  /// \throws pcl::BadArgumentException if the points surround the given viewpoint.
  AxisMap compute() {
    return detail::withBadArguments([&] {
      if (!prepare()) return AxisMap();
      const AxisGrid grid(num_theta_, num_phi_, num_offset_, edt_->center(), edt_->radius());
      map_ = axialTransform(*edt_, grid, transform_, this->seen());
      return map_;
    });
  }

  /// \return the map of all centers of point symmetry; empty if the input holds no answer.
  /// \param num_centers number of centers along each edge, in [2, 512].
  /// \throws pcl::BadArgumentException as compute() does.
  CenterMap computeCenters(int num_centers = 64) {
    return detail::withBadArguments(
        [&] { return prepare() ? centralTransform(*edt_, num_centers, transform_, this->seen()) : CenterMap(); });
  }

  /// \param count greatest number of axes, >= 1.
  /// \param min_value least D, in [0, 1].
  /// \return the maxima of the last map, strongest first, see axisMaxima(). Their values are D alone, even for scans.
  std::vector<AxisMaximum> getAxes(int count = 5, double min_value = 0.5) const {
    return detail::withBadArguments(
        [&] { return edt_ ? axisMaxima(map_, *edt_, count, min_value, transform_) : std::vector<AxisMaximum>(); });
  }

protected:
  void clearResults() override {
    TransformAnalysis<PointT>::clearResults();
    map_ = {};
  }

private:
  using TransformAnalysis<PointT>::edt_;
  using TransformAnalysis<PointT>::edt_options_;

  /// \return whether the input holds an answer.
  bool prepare() { return this->makeDistanceTransform(transform_.seed, transform_.num_threads).cols() > 0; }

  AxialTransformOptions transform_;
  int num_theta_ = 16, num_phi_ = 64, num_offset_ = 32;
  AxisMap map_;
};

}  // namespace pcl_symmetry
