#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <algorithm>
#include <limits>
#include <mutex>

#include "core/evidence/plane_support.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace pcl_symmetry {

/// A pcl::search::Search seen from the normalised frame of the refinement.
///
/// It is given a cloud of just the points used: with indices, PCL's searches disagree on what the numbers that they
/// return count (FlannSearch: positions among the indices; the others: points of the cloud).
template <typename PointT>
class PCLPointSearch : public ClosestPointSearch {
public:
  PCLPointSearch(const typename pcl::search::Search<PointT>::Ptr& search, const pcl::PointCloud<PointT>& cloud,
                 const pcl::Indices& used, const GaussianEdt& edt)
      : search_(search), center_(edt.center()), scale_(edt.radius()) {
    search_->setInputCloud(pcl::make_shared<pcl::PointCloud<PointT>>(cloud, used));
  }

  void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    indices.resize(queries.cols() * num_neighbours);
    sq_distances.resize(indices.size());
    pcl::Indices found;
    std::vector<float> found_sq_distances;
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
      PointT query;
      query.getVector3fMap() = (queries.col(i).template cast<double>() * scale_ + center_).template cast<float>();
      if (search_->nearestKSearch(query, num_neighbours, found, found_sq_distances) < num_neighbours)
        throw std::invalid_argument("search method: found fewer neighbours than points, must find all");
      for (int k = 0; k < num_neighbours; ++k) {
        indices[i * num_neighbours + k] = static_cast<int>(found[k]);
        sq_distances[i * num_neighbours + k] = static_cast<float>(found_sq_distances[k] / (scale_ * scale_));
      }
    }
  }

private:
  typename pcl::search::Search<PointT>::Ptr search_;
  Eigen::Vector3d center_;
  double scale_;
  mutable std::mutex mutex_;
};

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setOptions(const DetectionOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  options_ = options;
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setMinConfidence(double min_confidence) {
  DetectionOptions options = options_;
  options.min_confidence = min_confidence;
  setOptions(options);
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setApproximate(bool approximate) {
  options_.approximate = approximate;
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setMaxPlanes(int max_planes) {
  DetectionOptions options = options_;
  options.max_planes = max_planes;
  setOptions(options);
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setGridSize(int num_cells) {
  DetectionOptions options = options_;
  options.edt.num_cells = num_cells;
  setOptions(options);
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setSigma(double sigma) {
  DetectionOptions options = options_;
  options.edt.sigma = sigma;
  setOptions(options);
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setRandomSeed(std::uint64_t seed) {
  options_.seed = seed;
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setNumberOfThreads(int num_threads) {
  DetectionOptions options = options_;
  options.num_threads = options.edt.num_threads = num_threads;
  setOptions(options);
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 2);
  max_points_ = max_points;
}

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setSymmetryMap(const SymmetryMap& map,
                                                      const std::shared_ptr<const GaussianEdt>& edt) {
  if (map.empty() || !edt) detail::throwBadArgument("symmetry map: empty, must be made by PlanarSymmetryTransform");
  map_ = map;
  edt_ = edt;
}

template <typename PointT>
std::vector<SymmetryPlane> SymmetryMaximaRefinement<PointT>::compute() {
  return detail::withBadArguments([&] {
    if (!input_) throw std::invalid_argument("input cloud: not set, must be given by setInputCloud");
    detail::SelectedPoints selected =
        detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, max_points_, options_.seed);
    used_indices_ = std::move(selected.indices);
    used_points_ = std::move(selected.points);
    const auto search = [&](const GaussianEdt& edt) -> ClosestPointSearch::Ptr {
      return search_ ? std::make_shared<PCLPointSearch<PointT>>(search_, *input_, used_indices_, edt) : nullptr;
    };
    const std::optional<Visibility> seen = detail::seenSpace(*input_, used_points_, viewpoint_);
    used_viewpoint_ = seen.has_value();
    const Visibility* visibility = seen ? &*seen : nullptr;
    Detection detection = edt_ ? refineMaxima(used_points_, *edt_, map_, options_, search(*edt_), visibility)
                               : detectPlanes(used_points_, options_, search, visibility);
    own_map_ = std::move(detection.map);
    axes_ = std::move(detection.axes);
    centers_ = std::move(detection.centers);
    timing_ms_ = std::move(detection.timing_ms);
    return std::move(detection.planes);
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  return detail::withBadArguments([&] {
    if (used_points_.cols() == 0) throw std::invalid_argument("input cloud: not analysed, must be by compute()");
    const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
    const std::vector<float> finite = planeSupport(all.points, used_points_, plane, options_.num_threads);
    std::vector<float> support(input_->size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < finite.size(); ++i) support[all.indices[i]] = finite[i];
    return support;
  });
}

template <typename PointT>
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PointCloud<PointT>& cloud, const DetectionOptions& options) {
  SymmetryMaximaRefinement<PointT> refinement;
  refinement.setOptions(options);
  // The cloud outlives this call: no copy.
  refinement.setInputCloud(typename pcl::PointCloud<PointT>::ConstPtr(&cloud, [](const void*) {}));
  return refinement.compute();
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetryMaximaRefinement(T)                                     \
  template class pcl_symmetry::SymmetryMaximaRefinement<T>;                             \
  template std::vector<pcl_symmetry::SymmetryPlane> pcl_symmetry::detectSymmetryPlanes( \
      const pcl::PointCloud<T>&, const pcl_symmetry::DetectionOptions&);
