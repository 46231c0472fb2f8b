#include "pcl_symmetry/planar_symmetry_transform.h"

#include "core/distance_transform/free_space.h"

namespace pcl_symmetry::detail {

SymmetryMap mapOfPlanes(const Points& points, const GaussianEdt& edt, const PlaneGrid& grid,
                        const PlanarTransformOptions& options, const Visibility* seen) {
  std::vector<float> free_space;
  if (seen) free_space = freeSpace(edt, *seen, options.sampled.num_threads);
  return planarTransform(edt, grid, centerOfMass(points), options, free_space);
}

}  // namespace pcl_symmetry::detail
