#include "pcl_symmetry/core/planar_transform.h"

#include <algorithm>

#include "core/transform/free_space.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

SymmetryMap mapWithoutSight(const GaussianEdt& edt, const PlaneGrid& grid, const PlanarTransformOptions& options) {
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
  return sampledTransform(edt, grid, options.sampled);
}

}  // namespace

std::size_t SymmetryMap::strongest() const {
  return std::max_element(values.begin(), values.end()) - values.begin();
}

SymmetryMap SymmetryMap::zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method) {
  return {grid, std::vector<float>(grid.size(), 0.0f), method, edt.sigma(), grid.center()};
}

void PlanarTransformOptions::validate() const {
  sampled.validate();
  convolution.validate();
  rotational.validate();
  voting.validate();
}

SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options, const Visibility* visibility) {
  std::vector<float> free_space;
  if (visibility) free_space = freeSpace(edt, *visibility, options.sampled.num_threads);
  SymmetryMap map;
  if (visibility && options.method == TransformMethod::Sampled) {
    map = sampledTransform(edt, grid, options.sampled, free_space);
  } else {
    map = mapWithoutSight(edt, grid, options);
    if (visibility) weighSeen(map, freeOverlap(edt, grid, free_space, options.sampled));
  }
  map.center_of_mass = center_of_mass;
  return map;
}

}  // namespace pcl_symmetry
