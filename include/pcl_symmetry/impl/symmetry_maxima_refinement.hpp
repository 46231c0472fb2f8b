#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <limits>
#include <mutex>
#include <optional>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// \param points 3 x M, finite.
/// \param samples 3 x N, finite, the surface that reflected points are compared with, same frame.
/// \return the support for the plane at each of the points, in [0, 1].
std::vector<float> pointSupport(const Points& points, const Points& samples, const ReflectionPlane& plane,
                                int num_threads);

/// A pcl::search::Search that answers questions in the normalised frame of the refinement.
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

}  // namespace detail

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
    Points points = this->selectInput(options_.seed);
    if (points.cols() == 0) return std::vector<SymmetryPlane>();
    const auto search = [&](const GaussianEdt& edt) -> ClosestPointSearch::Ptr {
      if (!search_) return nullptr;
      return std::make_shared<detail::PCLPointSearch<PointT>>(search_, *input_, this->getUsedIndices(), edt);
    };
    const std::optional<Visibility> seen = this->seenSpace(points);
    const Visibility* visibility = seen ? &*seen : nullptr;
    const std::optional<Points> normals =
        use_input_normals_ ? detail::normalsOf(*input_, this->getUsedIndices()) : std::nullopt;
    const Points* given = normals ? &*normals : nullptr;
    Detection detection = edt_ ? refineMaxima(points, *edt_, map_, options_, search(*edt_), visibility, given)
                               : detectPlanes(points, options_, search, visibility, given);
    used_points_ = std::move(points);
    own_map_ = std::move(detection.map);
    axes_ = std::move(detection.axes);
    centers_ = std::move(detection.centers);
    turns_ = std::move(detection.turns);
    best_ = std::move(detection.best);
    used_tolerance_ = detection.tolerance;
    timing_ms_ = std::move(detection.timing_ms);
    return std::move(detection.planes);
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  std::vector<float> support(input_ ? input_->size() : 0, std::numeric_limits<float>::quiet_NaN());
  if (used_points_.cols() == 0) return support;
  const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
  const std::vector<float> finite = detail::pointSupport(all.points, used_points_, plane, options_.num_threads);
  for (std::size_t i = 0; i < finite.size(); ++i) support[all.indices[i]] = finite[i];
  return support;
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetryMaximaRefinement(T) \
  template class PCL_SYMMETRY_EXPORTS pcl_symmetry::SymmetryMaximaRefinement<T>;
