#include "pcl_symmetry/symmetry_detection.h"

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh, const DetectionOptions& options,
                                                int num_points) {
  return detectSymmetryPlanes(*sampleMesh(mesh, num_points, options.seed), options);
}

}  // namespace pcl_symmetry
