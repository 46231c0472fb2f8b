/// The planar-reflective symmetry transform as a descriptor of shape (Section 5.2).
#pragma once

#include <pcl/console/print.h>
#include <pcl/features/feature.h>
#include <pcl/impl/pcl_base.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/point_types.h"
#include "pcl_symmetry/viewpoint.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// Parameters of PRSTEstimation.
struct PRSTParameters {
  bool use_input_axes = false;
  bool by_equation_1 = false;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core
};

/// All descriptors of a shape.
using SymmetrySignatures = std::tuple<PRSTSignature32768, PRSDSignature1024, GEDTSignature32768>;

/// \param points 3 x N, finite, input units.
/// \param seen what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for points without extent.
SymmetrySignatures describeBySymmetry(const Points& points, const PRSTParameters& parameters, const Visibility* seen);

}  // namespace detail

/// The planar-reflective symmetry transform as a global descriptor: one for the whole cloud (Section 5.2). With another
/// output type, the class computes one of the descriptors that the paper compares it with, PRSD and GEDT: see
/// PRSDEstimation and GEDTEstimation.
///
/// Honors setIndices; points that are not finite are left out. The descriptor has no neighborhoods: setRadiusSearch,
/// setKSearch, setSearchMethod and setSearchSurface of the base class are ignored. Clouds that hold no answer (no
/// finite point, all points at one position) give an empty output and a PCL_WARN.
///
/// \code
/// pcl_symmetry::PRSTEstimation<pcl::PointXYZ> estimation;
/// estimation.setInputCloud(cloud);
/// pcl::PointCloud<pcl_symmetry::PRSTSignature32768> descriptor;
/// estimation.compute(descriptor);
/// \endcode
template <typename PointInT, typename PointOutT = PRSTSignature32768>
class PRSTEstimation : public pcl::Feature<PointInT, PointOutT> {
public:
  using Ptr = pcl::shared_ptr<PRSTEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const PRSTEstimation<PointInT, PointOutT>>;
  using PointCloudOut = typename pcl::Feature<PointInT, PointOutT>::PointCloudOut;

  PRSTEstimation() { this->feature_name_ = "PRSTEstimation"; }

  /// \param use_input_axes true: the descriptor is computed about the center of mass in the axes of the cloud, as the
  /// paper does with models that were aligned by hand. false (default): in the canonical frame of the cloud, see
  /// SymmetryAlignment.
  void setUseInputAxes(bool use_input_axes) { parameters_.use_input_axes = use_input_axes; }
  /// \param by_equation_1 true: values of PRST and PRSD are sqrt((1 + D) / 2) as in Equation 1. false (default): they
  /// are sqrt(max(D, 0)), which is 0 for planes without any symmetry.
  void setByEquation1(bool by_equation_1) { parameters_.by_equation_1 = by_equation_1; }

  void setRandomSeed(std::uint64_t seed) { parameters_.seed = seed; }  ///< Sets the seed of all random draws.

  /// \param num_threads >= 0; 0 = one per core (default).
  /// \throws pcl::BadArgumentException for a negative number.
  void setNumberOfThreads(int num_threads) {
    detail::checkAtLeast("num_threads", num_threads, 0);
    parameters_.num_threads = num_threads;
  }

  /// \param max_points number of points drawn from a larger cloud, >= 2; default 20 000.
  /// \throws pcl::BadArgumentException for fewer than 2.
  void setMaxPoints(std::size_t max_points) {
    detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 2);
    max_points_ = max_points;
  }

  /// Sets where the scanner stood; by default it follows from the data, as in SymmetryAlignment.
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = detail::checkedViewpoint(viewpoint); }

protected:
  using pcl::Feature<PointInT, PointOutT>::input_;
  using pcl::Feature<PointInT, PointOutT>::indices_;

  /// Replaces initCompute() of the base class, which builds a search tree and makes one output point for each index.
  /// \throws pcl::BadArgumentException if the points surround the given viewpoint.
  bool initCompute() override {
    warnOfIgnoredSearch();
    if (!pcl::PCLBase<PointInT>::initCompute()) return warnOfNoAnswer("input cloud: not set");
    points_ = detail::selectPoints(*input_, indices_.get(), max_points_, parameters_.seed).points;
    const std::string reason =
        detail::reasonForNoAnswer(points_, "input cloud", 0, this->use_indices_ ? indices_.get() : nullptr);
    if (!reason.empty()) return warnOfNoAnswer(reason);
    const bool is_part = this->use_indices_ && indices_->size() < input_->size();
    seen_ = detail::withBadArguments([&] { return detail::findSeenSpace(*input_, points_, viewpoint_, is_part); });
    all_indices_ = indices_;
    indices_ = pcl::make_shared<pcl::Indices>(1, 0);
    return true;
  }

  /// Restores the indices.
  bool deinitCompute() override {
    indices_ = all_indices_;
    all_indices_.reset();
    points_.resize(3, 0);
    seen_ = {};
    return pcl::PCLBase<PointInT>::deinitCompute();
  }

  /// Fills the one point of the output.
  void computeFeature(PointCloudOut& output) override {
    output.width = output.height = 1;
    try {
      output[0] = std::get<PointOutT>(detail::describeBySymmetry(points_, parameters_, seen_.visibility()));
    } catch (const std::invalid_argument& reason) {
      warnOfNoAnswer(std::string("input cloud: ") + reason.what());
      output.clear();
      output.height = 1;
    }
  }

private:
  /// \return false.
  bool warnOfNoAnswer(const std::string& reason) const {
    detail::warnOfNoAnswer(this->getClassName(), reason);
    return false;
  }

  void warnOfIgnoredSearch() {
    if (warned_ || (this->search_radius_ == 0.0 && this->k_ == 0)) return;
    warned_ = true;
    PCL_WARN("[pcl_symmetry::%s] setRadiusSearch and setKSearch are ignored\n", this->getClassName().c_str());
  }

  detail::PRSTParameters parameters_;
  std::size_t max_points_ = 20'000;
  Viewpoint viewpoint_;
  bool warned_ = false;  // whether PCL_WARN has said that the search is ignored
  // Set while a descriptor is computed:
  pcl::IndicesPtr all_indices_;
  Points points_;
  SeenSpace seen_;
};

/// The reflective symmetry descriptor of Kazhdan et al. (2004), which the paper compares with (Figure 13).
template <typename PointInT>
using PRSDEstimation = PRSTEstimation<PointInT, PRSDSignature1024>;
/// The Gaussian Euclidean distance transform as a descriptor (Figures 13 and 14).
template <typename PointInT>
using GEDTEstimation = PRSTEstimation<PointInT, GEDTSignature32768>;

/// The product of the L2 distances of PRST and GEDT, which the paper proposes for retrieval (Section 5.2).
/// \return >= 0.
float productDistance(const PRSTSignature32768& prst_a, const GEDTSignature32768& gedt_a,
                      const PRSTSignature32768& prst_b, const GEDTSignature32768& gedt_b);

/// L2 distance, differences weighted by sqrt(sin theta), the size of the bins (Section 5.2).
/// \return >= 0.
float descriptorDistance(const PRSTSignature32768& a, const PRSTSignature32768& b);
/// The same for PRSD. Departure from the paper: Kazhdan et al. (2004) take the maximum difference; L2 compares both
/// descriptors alike.
/// \return >= 0.
float descriptorDistance(const PRSDSignature1024& a, const PRSDSignature1024& b);
/// L2 distance.
/// \return >= 0.
float descriptorDistance(const GEDTSignature32768& a, const GEDTSignature32768& b);

}  // namespace pcl_symmetry
