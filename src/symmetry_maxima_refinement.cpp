#include "pcl_symmetry/impl/symmetry_maxima_refinement.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include <limits>
#include <utility>

#include "core/evidence/plane_support.h"

namespace pcl_symmetry::detail {

DetectedPlanes foundPlanes(Points points, const GaussianEdt* edt, const SymmetryMap& map,
                           const DetectionOptions& options, const MakeSearch& search,
                           const std::optional<Visibility>& seen, const std::optional<Points>& normals) {
  PlaneInput input(points, seen ? &*seen : nullptr);
  if (normals) input.normals = &*normals;
  if (edt) {
    input.edt = edt;
    input.map = &map;
  }
  input.make_search = search;
  DetectedPlanes found;
  static_cast<Detection&>(found) = detectPlanes(input, options);
  found.points = std::move(points);
  return found;
}

std::vector<float> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                const ReflectionPlane& plane, int num_threads) {
  std::vector<float> support(cloud_size, std::numeric_limits<float>::quiet_NaN());
  if (samples.cols() == 0) return support;
  const std::vector<float> finite = planeSupport(all.points, samples, plane, num_threads);
  for (std::size_t i = 0; i < finite.size(); ++i) support[all.indices[i]] = finite[i];
  return support;
}

}  // namespace pcl_symmetry::detail

PCL_INSTANTIATE(SymmetryMaximaRefinement, PCL_XYZ_POINT_TYPES)
