#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <optional>

#include "pcl_symmetry/core/volume_planes.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// The planes as published, of points whose transform may be known.
/// \param edt,map of these points; edt null: the map is computed.
Detection planesAsPublished(const Points& points, const GaussianEdt* edt, const SymmetryMap& map,
                            const DetectionOptions& options);

/// \param all finite points of a cloud.
/// \param cloud_size points of the cloud.
/// \param samples 3 x N, finite, the surface that reflected points are compared with, same frame; N = 0: no surface.
/// \param seen what the scanner saw of the cloud; null: it shows its object from all sides.
/// \return for each plane its support at each point of the cloud, in [0, 1]; NaN where it is not known.
std::vector<std::vector<float>> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                             const std::vector<ReflectionPlane>& planes, const Visibility* seen,
                                             int num_threads);

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
    if (this->volume_) {
      clearResults();
      found_ = detectVolumePlanes(*this->volume_, options_, this->levels_);
      if (!found_.reason.empty()) this->giveNoAnswer(found_.reason);
      return found_.planes;
    }
    samples_ = this->selectInput(options_.seed, options_.num_threads, as_published_);
    if (samples_.cols() == 0) {
      found_.reason = this->getReason();
      return found_.planes;
    }
    if (as_published_) {
      found_ = detail::planesAsPublished(samples_, edt_.get(), map_, options_);
      return found_.planes;
    }
    PlaneInput input(samples_, this->seenSpace(samples_));
    const std::optional<Points> normals =
        use_input_normals_ ? detail::normalsOf(*input_, this->getUsedIndices()) : std::nullopt;
    if (normals) input.normals = &*normals;
    input.edt = edt_.get();
    input.map = edt_ ? &map_ : nullptr;
    input.make_search = this->makeSearch();
    input.may_be_rings = this->hasGivenSupport() && this->getViewpointSource() != ViewpointSource::Rays;
    found_ = detectPlanes(input, options_);
    if (mesh_ && !input.visibility) refineOnMesh(*mesh_, found_, options_);
    return found_.planes;
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  return computePointSupport(std::vector<ReflectionPlane>{plane}).front();
}

template <typename PointT>
std::vector<std::vector<float>> SymmetryMaximaRefinement<PointT>::computePointSupport(
    const std::vector<ReflectionPlane>& planes) const {
  if (!input_) return std::vector<std::vector<float>>(planes.size());
  const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
  return detail::pointSupport(all, input_->size(), samples_, planes, this->seen(), options_.num_threads);
}

}  // namespace pcl_symmetry

// The attribute of GNU, because Clang takes none in brackets here.
#define PCL_INSTANTIATE_SymmetryMaximaRefinement(T) \
  template class __attribute__((visibility("default"))) pcl_symmetry::SymmetryMaximaRefinement<T>;
