#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"
#include "pcl_symmetry/impl/pcl_search.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Finds the canonical frame of a cloud, whole or seen from one side: its center of symmetry and its principal symmetry
/// axes (Section 5.1 of the paper).
template <typename PointT>
class SymmetryAlignment : public ScanAnalysis<PointT> {
public:
  using Ptr = pcl::shared_ptr<SymmetryAlignment<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryAlignment<PointT>>;
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;

  /// Uses at most 50 000 points, see setMaxPoints().
  SymmetryAlignment() : ScanAnalysis<PointT>("SymmetryAlignment", 50'000) {}

  /// Sets every option at once.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as all setters here.
  void setOptions(const FrameOptions& options) {
    change([&](FrameOptions& changed) { changed = options; });
  }
  const FrameOptions& getOptions() const { return options_; }  ///< see setOptions()

  /// \param num_cells cells of the distance transform along each side, in [8, 512]; default 64.
  void setGridSize(int num_cells) {
    change([&](FrameOptions& changed) { changed.num_cells = num_cells; });
  }
  void setRandomSeed(std::uint64_t seed) { options_.seed = seed; }  ///< of all random draws
  /// \param num_threads >= 0; 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads) {
    change([&](FrameOptions& changed) { changed.num_threads = num_threads; });
  }

  /// Finds the closest points by a search of PCL in place of FLANN's k-d tree. Only the axes of turns of a scan need
  /// any (FrameOptions::turns).
  /// \param search as in SymmetryMaximaRefinement::setSearchMethod(). Null: FLANN (default).
  void setSearchMethod(const SearchPtr& search) { search_ = search; }

  /// \return the frame, in the frame of the input; SymmetryFrame::equivalent is empty where the input holds no answer,
  /// see getReason().
  /// \throws pcl::BadArgumentException where the points surround the viewpoint that was given.
  SymmetryFrame compute();

  /// \return stages of the last compute() and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return timing_ms_; }

protected:
  void clearResults() override {
    ScanAnalysis<PointT>::clearResults();
    timing_ms_.clear();
  }

private:
  template <typename Change>
  void change(const Change& change) {
    detail::changeOptions(options_, change);
  }

  FrameOptions options_;
  SearchPtr search_;
  std::vector<std::pair<std::string, double>> timing_ms_;
};

template <typename PointT>
SymmetryFrame SymmetryAlignment<PointT>::compute() {
  return detail::withBadArguments([&] {
    const auto start = std::chrono::steady_clock::now();
    const Points points = this->selectInput(options_.seed, options_.num_threads, options_.as_published);
    if (points.cols() == 0) return SymmetryFrame();
    const std::optional<Visibility> seen = this->seenSpace(points);
    const std::chrono::duration<double, std::milli> seen_ms = std::chrono::steady_clock::now() - start;
    SymmetryFrame frame = symmetryFrame(points, options_, seen ? &*seen : nullptr,
                                        detail::searchOf<PointT>(search_, "SymmetryAlignment", options_.num_threads));
    frame.timing_ms.insert(frame.timing_ms.begin(), {"seen_space", seen_ms.count()});
    timing_ms_ = frame.timing_ms;
    return frame;
  });
}

}  // namespace pcl_symmetry
