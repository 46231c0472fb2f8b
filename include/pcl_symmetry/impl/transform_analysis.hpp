#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The input of classes that compute a transform, as the function f that it is made from: the distance transform of
/// points (Section 4.1), or a volume (Section 4.2).
template <typename PointT>
class TransformAnalysis : public ScanAnalysis<PointT> {
public:
  using CloudAnalysis<PointT>::setInputVolume;

  /// \param num_cells cells of the distance transform along each side, in [8, 512]; default 64, in
  /// AxialSymmetryTransform 32. Twice as many resolve details half as large.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as do all setters here.
  void setNumCells(int num_cells) {
    detail::changeOptions(edt_options_, [&](GaussianEdtOptions& changed) { changed.num_cells = num_cells; });
  }
  /// \param sigma width of the Gaussian, input units, >= 0; 0 (default) = two cells, or the spacing of the points where
  /// that is more.
  void setSigma(double sigma) {
    detail::changeOptions(edt_options_, [&](GaussianEdtOptions& changed) { changed.sigma = sigma; });
  }

  /// \return the function f that the last map was made from; null without one.
  std::shared_ptr<const GaussianEdt> getDistanceTransform() const { return edt_; }

protected:
  /// Uses at most 200 000 points, see setMaxPoints().
  explicit TransformAnalysis(std::string name) : ScanAnalysis<PointT>(std::move(name), 200'000) {}

  void clearResults() override {
    ScanAnalysis<PointT>::clearResults();
    edt_.reset();
  }

  /// Begins an analysis: makes f, and finds what the scanner saw of points.
  /// \return 3 x N points of the cloud, or of the body in the volume; N = 0 where the input holds no answer.
  Points makeDistanceTransform(std::uint64_t seed, int num_threads) {
    edt_options_.num_threads = num_threads;
    if (this->volume_) {
      clearResults();
      std::optional<VolumeFunction> f;  // on about as many voxels as the distance transform has cells
      try {
        const auto side = static_cast<std::size_t>(std::max(edt_options_.num_cells, 16));
        f.emplace(*this->volume_, this->levels_, side * side * side, num_threads);
      } catch (const std::invalid_argument& error) {
        return this->giveNoAnswer(error.what());
      }
      edt_ = std::make_shared<const GaussianEdt>(*f, edt_options_);
      return f->bodyPoints(false);
    }
    Points points = this->selectInput(seed, num_threads);
    if (points.cols() == 0) return points;
    this->seenSpace(points);
    edt_ = std::make_shared<const GaussianEdt>(points, edt_options_);
    return points;
  }

  GaussianEdtOptions edt_options_;          ///< options of the distance transform
  std::shared_ptr<const GaussianEdt> edt_;  ///< see getDistanceTransform()
};

}  // namespace pcl_symmetry
