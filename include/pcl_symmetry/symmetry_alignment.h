#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/impl/pcl_search.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Finds the canonical frame of a cloud, whole or seen from one side: its center of symmetry and its principal symmetry
/// axes (Section 5.1 of the paper).
template <typename PointT>
class SymmetryAlignment : public SearchingAnalysis<ScanAnalysis<PointT>, FrameOptions> {
public:
  using Ptr = pcl::shared_ptr<SymmetryAlignment<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryAlignment<PointT>>;

  /// Uses at most 50 000 points, see setMaxPoints().
  SymmetryAlignment() : SearchingAnalysis<ScanAnalysis<PointT>, FrameOptions>("SymmetryAlignment", 50'000) {}

  /// \return the frame, in the frame of the input; SymmetryFrame::equivalent is empty where the input holds no answer,
  /// see getReason().
  /// \throws pcl::BadArgumentException if the points surround the viewpoint that was given.
  SymmetryFrame compute();

  /// \return stages of the last compute() and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return timing_ms_; }

protected:
  void clearResults() override {
    ScanAnalysis<PointT>::clearResults();
    timing_ms_.clear();
  }

private:
  using SearchingAnalysis<ScanAnalysis<PointT>, FrameOptions>::options_;

  std::vector<std::pair<std::string, double>> timing_ms_;
};

template <typename PointT>
SymmetryFrame SymmetryAlignment<PointT>::compute() {
  return detail::withBadArguments([&] {
    const auto start = std::chrono::steady_clock::now();
    const Points points = this->selectInput(options_.seed, options_.num_threads, options_.as_published);
    if (points.cols() == 0) return SymmetryFrame();
    const Visibility* seen = this->seenSpace(points);
    const std::chrono::duration<double, std::milli> seen_ms = std::chrono::steady_clock::now() - start;
    SymmetryFrame frame = symmetryFrame(points, options_, seen, this->makeSearch());
    frame.timing_ms.insert(frame.timing_ms.begin(), {"seen_space", seen_ms.count()});
    timing_ms_ = frame.timing_ms;
    return frame;
  });
}

}  // namespace pcl_symmetry
