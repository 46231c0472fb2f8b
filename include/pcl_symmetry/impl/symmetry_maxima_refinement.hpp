#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <functional>
#include <mutex>
#include <optional>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

using MakeSearch = std::function<ClosestPointSearch::Ptr(const GaussianEdt&)>;

/// What does not depend on the type of the points of SymmetryMaximaRefinement::compute().
/// \param edt,map of these points; edt null: the map is computed.
/// \param search null: the library's own.
DetectedPlanes foundPlanes(Points points, const GaussianEdt* edt, const SymmetryMap& map,
                           const DetectionOptions& options, const MakeSearch& search,
                           const std::optional<Visibility>& seen, const std::optional<Points>& normals);

/// \param all finite points of a cloud.
/// \param cloud_size points of the cloud.
/// \param samples 3 x N, finite, the surface that reflected points are compared with, same frame; N = 0: no surface.
/// \return the support for the plane at each point of the cloud, in [0, 1]; NaN where it is not known.
std::vector<float> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                const ReflectionPlane& plane, int num_threads);

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
    Points points = this->selectInput(options_.seed, options_.num_threads);
    if (points.cols() == 0) return std::vector<SymmetryPlane>();
    const auto search = [&](const GaussianEdt& edt) -> ClosestPointSearch::Ptr {
      return std::make_shared<detail::PCLPointSearch<PointT>>(search_, *input_, this->getUsedIndices(), edt);
    };
    const std::optional<Visibility> seen = this->seenSpace(points);
    const std::optional<Points> normals =
        use_input_normals_ ? detail::normalsOf(*input_, this->getUsedIndices()) : std::nullopt;
    found_ = detail::foundPlanes(std::move(points), edt_.get(), map_, options_,
                                 search_ ? detail::MakeSearch(search) : nullptr, seen, normals);
    return std::move(found_.planes);
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  if (!input_) return {};
  const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
  return detail::pointSupport(all, input_->size(), found_.points, plane, options_.num_threads);
}

}  // namespace pcl_symmetry

// The attribute of GNU, because Clang takes none in brackets here.
#define PCL_INSTANTIATE_SymmetryMaximaRefinement(T) \
  template class __attribute__((visibility("default"))) pcl_symmetry::SymmetryMaximaRefinement<T>;
