#include "pcl_symmetry/impl/symmetry_maxima_refinement.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "core/evidence/plane_support.h"

namespace pcl_symmetry::detail {

std::vector<float> pointSupport(const Points& points, const Points& samples, const ReflectionPlane& plane,
                                int num_threads) {
  return planeSupport(points, samples, plane, num_threads);
}

}  // namespace pcl_symmetry::detail

PCL_INSTANTIATE(SymmetryMaximaRefinement, PCL_XYZ_POINT_TYPES)
