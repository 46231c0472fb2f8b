#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <algorithm>
#include <stdexcept>

#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/features/prst.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

template <typename PointInT, typename PointOutT>
void PRSTEstimation<PointInT, PointOutT>::setRadius(double radius) {
  if (!(radius > 0.0)) PCL_THROW_EXCEPTION(pcl::BadArgumentException, "radius = " << radius << ", must be > 0");
  options_.radius = radius;
}

template <typename PointInT, typename PointOutT>
void PRSTEstimation<PointInT, PointOutT>::setNumberOfThreads(int num_threads) {
  if (num_threads < 0)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException, "num_threads = " << num_threads << ", must be >= 0");
  options_.num_threads = num_threads;
}

template <typename PointInT, typename PointOutT>
void PRSTEstimation<PointInT, PointOutT>::setMaxPoints(std::size_t max_points) {
  if (max_points < 2) PCL_THROW_EXCEPTION(pcl::BadArgumentException, "max_points = " << max_points << ", must be >= 2");
  max_points_ = max_points;
}

/// The base class makes one output point for each index, and a search tree: here one for all, and none.
template <typename PointInT, typename PointOutT>
bool PRSTEstimation<PointInT, PointOutT>::initCompute() {
  if (!pcl::PCLBase<PointInT>::initCompute()) {
    PCL_ERROR("[pcl_symmetry::%s::initCompute] No input cloud, or no points in it\n", this->getClassName().c_str());
    return false;
  }
  all_indices_ = indices_;
  indices_ = pcl::make_shared<pcl::Indices>(1, 0);
  return true;
}

template <typename PointInT, typename PointOutT>
bool PRSTEstimation<PointInT, PointOutT>::deinitCompute() {
  indices_ = all_indices_;
  all_indices_.reset();
  return pcl::PCLBase<PointInT>::deinitCompute();
}

template <typename PointInT, typename PointOutT>
void PRSTEstimation<PointInT, PointOutT>::computeFeature(PointCloudOut& output) {
  output.width = output.height = 1;
  try {
    const detail::SelectedPoints selected = detail::selectPoints(*input_, all_indices_.get(), max_points_, options_.seed);
    Eigen::Isometry3d T_frame_input = Eigen::Isometry3d::Identity();
    if (use_input_axes_) {
      T_frame_input.translation() = -centerOfMass(selected.points);
    } else {
      FrameOptions frame;
      frame.seed = options_.seed;
      frame.num_threads = frame.edt.num_threads = options_.num_threads;
      const std::optional<Visibility> seen = detail::seenSpace(*input_, selected.points, viewpoint_);
      T_frame_input = symmetryFrame(selected.points, frame, seen ? &*seen : nullptr).T_canonical_input;
    }
    const std::vector<float> prst = symmetryDescriptors(selected.points, T_frame_input, options_).prst;
    std::copy(prst.begin(), prst.end(), output[0].prst);
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl_symmetry::%s::computeFeature] %s\n", this->getClassName().c_str(), error.what());
    output.clear();
    output.height = 1;
  }
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_PRSTEstimation(T, OutT) template class pcl_symmetry::PRSTEstimation<T, OutT>;
