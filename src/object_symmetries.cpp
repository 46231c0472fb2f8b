#include "pcl_symmetry/impl/object_symmetries.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

ObjectSymmetries detectObjectSymmetries(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options,
                                        int num_points) {
  return detectObjectSymmetries(*sampleMesh(mesh, num_points, options.seed), options);
}

}  // namespace pcl_symmetry

PCL_INSTANTIATE(detectObjectSymmetries, PCL_XYZ_POINT_TYPES)
