#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <optional>

#include "pcl_symmetry/core/volume_planes.h"
#include "pcl_symmetry/impl/pcl_search.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// What does not depend on the type of the points of SymmetryMaximaRefinement::compute().
/// \param edt,map of these points; edt null: the map is computed.
/// \param search null: the library's own.
/// \param may_be_rings the points may be those of a LiDAR's rings: their upright box decides where they are no surface.
Detection foundPlanes(const Points& points, const GaussianEdt* edt, const SymmetryMap& map,
                      const DetectionOptions& options, const MakeSearch& search, const std::optional<Visibility>& seen,
                      const std::optional<Points>& normals, bool may_be_rings);

/// The same as published.
Detection planesAsPublished(const Points& points, const GaussianEdt* edt, const SymmetryMap& map,
                            const DetectionOptions& options);

/// \param all finite points of a cloud.
/// \param cloud_size points of the cloud.
/// \param samples 3 x N, finite, the surface that reflected points are compared with, same frame; N = 0: no surface.
/// \return the support for the plane at each point of the cloud, in [0, 1]; NaN where it is not known.
std::vector<float> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                const ReflectionPlane& plane, int num_threads);

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
    if (this->volume()) {
      clearResults();
      found_ = detectVolumePlanes(*this->volume(), options_, this->levels());
      if (!found_.reason.empty()) this->giveNoAnswer(found_.reason);
      return found_.planes;
    }
    samples_ = this->selectInput(options_.seed, options_.num_threads, as_published_);
    if (samples_.cols() == 0) return found_.planes;
    if (as_published_) {
      found_ = detail::planesAsPublished(samples_, edt_.get(), map_, options_);
      return found_.planes;
    }
    const MakeSearch search = detail::searchOf<PointT>(search_, "SymmetryMaximaRefinement", options_.num_threads);
    const std::optional<Visibility> seen = this->seenSpace(samples_);
    const std::optional<Points> normals =
        use_input_normals_ ? detail::normalsOf(*input_, this->getUsedIndices()) : std::nullopt;
    const bool may_be_rings = this->hasGivenSupport() && this->getViewpointSource() != ViewpointSource::Rays;
    found_ = detail::foundPlanes(samples_, edt_.get(), map_, options_, search, seen, normals, may_be_rings);
    if (mesh_ && !seen) refineOnMesh(*mesh_, found_, options_);
    return found_.planes;
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  if (!input_) return {};
  const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
  return detail::pointSupport(all, input_->size(), samples_, plane, options_.num_threads);
}

}  // namespace pcl_symmetry

// The attribute of GNU, because Clang takes none in brackets here.
#define PCL_INSTANTIATE_SymmetryMaximaRefinement(T) \
  template class __attribute__((visibility("default"))) pcl_symmetry::SymmetryMaximaRefinement<T>;
