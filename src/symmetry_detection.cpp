#include "pcl_symmetry/symmetry_detection.h"

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh, const DetectionOptions& options,
                                                int num_points) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options);
  const auto points = sampleMesh(mesh, num_points, options.seed);
  refinement.setInputCloud(points);
  if (!points->empty()) refinement.setMesh(meshSurface(mesh));
  return detail::onlySymmetries(refinement.compute());
}

}  // namespace pcl_symmetry
