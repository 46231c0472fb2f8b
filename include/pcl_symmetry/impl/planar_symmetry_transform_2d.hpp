#pragma once

#include <pcl/impl/pcl_base.hpp>

#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/planar_symmetry_transform_2d.h"

namespace pcl_symmetry {

template <typename PointT>
void PlanarSymmetryTransform2D<PointT>::setGridSize(int n) {
  GaussianEdt2DOptions options = edt_options_;
  options.num_cells = n;
  detail::withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform2D<PointT>::setSigma(double sigma) {
  GaussianEdt2DOptions options = edt_options_;
  options.sigma = sigma;
  detail::withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform2D<PointT>::setMaximaOptions(const LocalMaximaOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  maxima_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform2D<PointT>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 2);
  max_points_ = max_points;
}

template <typename PointT>
void PlanarSymmetryTransform2D<PointT>::setNumberOfThreads(int num_threads) {
  detail::checkAtLeast("num_threads", static_cast<std::int64_t>(num_threads), 0);
  num_threads_ = maxima_.num_threads = num_threads;
}

template <typename PointT>
LineMap PlanarSymmetryTransform2D<PointT>::compute() {
  return detail::withBadArguments([&] {
    if (!input_) throw std::invalid_argument("input cloud: not set, must be given by setInputCloud");
    constexpr std::uint64_t kSeed = 1;
    const Points points =
        detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, max_points_, kSeed).points;
    if (points.cols() == 0) throw std::invalid_argument("input cloud: holds no finite point, must hold two");
    T_input_sheet_ = sheetPose(points);
    sheet_points_ =
        (T_input_sheet_.inverse() * points.template cast<double>()).template topRows<2>().template cast<float>();
    edt_ = std::make_shared<GaussianEdt2D>(sheet_points_, edt_options_);
    const LineGrid grid(edt_options_.num_cells, edt_options_.num_cells, edt_->center(), edt_->radius());
    LineMap map = lineTransform(*edt_, grid, sheet_points_.template cast<double>().rowwise().mean(), num_threads_);
    lines_ = findLineMaxima(*edt_, map, maxima_);
    return map;
  });
}

template <typename PointT>
ReflectionPlane PlanarSymmetryTransform2D<PointT>::getPlane(const ReflectionLine& line) const {
  const ReflectionPlane across(Eigen::Vector3d(line.normal().x(), line.normal().y(), 0.0), line.offset());
  return across.transformed(T_input_sheet_).canonical();
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_PlanarSymmetryTransform2D(T) template class pcl_symmetry::PlanarSymmetryTransform2D<T>;
