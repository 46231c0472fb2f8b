#include "pcl_symmetry/impl/symmetry_maxima_refinement.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh, const DetectionOptions& options,
                                                int num_points) {
  return detectSymmetryPlanes(*sampleMesh(mesh, num_points, options.seed), options);
}

}  // namespace pcl_symmetry

PCL_INSTANTIATE(SymmetryMaximaRefinement, PCL_XYZ_POINT_TYPES)
