#include "pcl_symmetry/core/planar_transform.h"

#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// \param free_space free space of a scan, which only the sampled transform uses.
SymmetryMap transformed(const GaussianEdt& edt, const PlaneGrid& grid, const PlanarTransformOptions& options,
                        const std::vector<float>& free_space) {
  switch (options.method) {
    case TransformMethod::Convolution:
      return convolutionTransform(edt, grid, options.convolution);
    case TransformMethod::Rotational:
      return rotationalTransform(edt, grid, options.rotational);
    case TransformMethod::Voting:
      return votingTransform(edt, grid, options.voting);
    case TransformMethod::Sampled:
      break;
  }
  return sampledTransform(edt, grid, options.sampled, free_space);
}

}  // namespace

void PlanarTransformOptions::validate() const {
  sampled.validate();
  convolution.validate();
  rotational.validate();
  voting.validate();
}

SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options, const Visibility* visibility) {
  const std::vector<float> free_space = freeSpace(edt, visibility, options.sampled.num_threads);
  SymmetryMap map = transformed(edt, grid, options, free_space);
  if (visibility && options.method != TransformMethod::Sampled)
    weighSeen(map, freeOverlap(edt, grid, free_space, options.sampled));
  map.center_of_mass = center_of_mass;
  return map;
}

}  // namespace pcl_symmetry
