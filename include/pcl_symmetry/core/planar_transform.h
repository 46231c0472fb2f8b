#pragma once

#include "pcl_symmetry/core/convolution_transform.h"
#include "pcl_symmetry/core/sampled_transform.h"
#include "pcl_symmetry/core/voting_transform.h"

namespace pcl_symmetry {

/// Which estimator, and the options of each.
struct PlanarTransformOptions {
  TransformMethod method = TransformMethod::Sampled;
  SampledTransformOptions sampled;
  ConvolutionTransformOptions convolution;
  VotingTransformOptions voting;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The planar-reflective symmetry transform of f by the method of the options.
/// \param grid the planes, in the frame of the EDT. \param center_of_mass of the points, in the same frame.
/// \param free_space of a scan, see freeSpace(): the map then holds seenSymmetry() of D, by the method of the options,
/// and of F, by sampling.
SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options = {}, const std::vector<float>& free_space = {});

}  // namespace pcl_symmetry
