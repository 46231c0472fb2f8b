#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <chrono>

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_alignment.h"

namespace pcl_symmetry {

template <typename PointT>
void SymmetryAlignment<PointT>::setOptions(const FrameOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  options_ = options;
}

template <typename PointT>
void SymmetryAlignment<PointT>::setTie(double tie) {
  FrameOptions options = options_;
  options.tie = tie;
  setOptions(options);
}

template <typename PointT>
void SymmetryAlignment<PointT>::setGridSize(int num_cells) {
  FrameOptions options = options_;
  options.edt.num_cells = num_cells;
  setOptions(options);
}

template <typename PointT>
void SymmetryAlignment<PointT>::setRandomSeed(std::uint64_t seed) {
  options_.seed = seed;
}

template <typename PointT>
void SymmetryAlignment<PointT>::setNumberOfThreads(int num_threads) {
  FrameOptions options = options_;
  options.num_threads = options.edt.num_threads = num_threads;
  setOptions(options);
}

template <typename PointT>
void SymmetryAlignment<PointT>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 2);
  max_points_ = max_points;
}

template <typename PointT>
SymmetryFrame SymmetryAlignment<PointT>::compute() {
  return detail::withBadArguments([&] {
    if (!input_) throw std::invalid_argument("input cloud: not set, must be given by setInputCloud");
    const auto start = std::chrono::steady_clock::now();
    detail::SelectedPoints selected =
        detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, max_points_, options_.seed);
    const std::optional<Visibility> seen = detail::seenSpace(*input_, selected.points, viewpoint_);
    const std::chrono::duration<double, std::milli> seen_ms = std::chrono::steady_clock::now() - start;
    SymmetryFrame frame = symmetryFrame(selected.points, options_, seen ? &*seen : nullptr);
    used_viewpoint_ = seen.has_value();
    used_indices_ = std::move(selected.indices);
    frame.timing_ms.insert(frame.timing_ms.begin(), {"seen_space", seen_ms.count()});
    timing_ms_ = frame.timing_ms;
    return frame;
  });
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetryAlignment(T) template class pcl_symmetry::SymmetryAlignment<T>;
