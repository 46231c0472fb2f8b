#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

void PlanarTransformOptions::validate() const {
  sampled.validate();
  convolution.validate();
  voting.validate();
}

SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options, const std::vector<float>& free_space) {
  SymmetryMap map;
  switch (options.method) {
    case TransformMethod::Sampled:
      map = sampledTransform(edt, grid, options.sampled, free_space);
      break;
    case TransformMethod::Convolution:
      map = convolutionTransform(edt, grid, options.convolution);
      break;
    case TransformMethod::Voting:
      map = votingTransform(edt, grid, options.voting);
      break;
  }
  if (!free_space.empty() && options.method != TransformMethod::Sampled)
    weighSeen(map, freeOverlap(edt, grid, free_space, options.sampled));
  map.center_of_mass = center_of_mass;
  return map;
}

}  // namespace pcl_symmetry
