#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/transform/line_kernel.h"
#include "core/transform/lookup_table.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Samples of f and their sums over images of them that lie on straight lines: what the transforms of axes and of
/// centers share with sampledTransform(). Lengths are cells, positions are measured from the middle of the EDT's cube.
class MovedLines {
public:
  /// \param table of f, and for scans of the free space; outlives this.
  MovedLines(const GaussianEdt& edt, const LookupTable& table, LineKernel accumulate, int num_steps);

  /// Adds up the table's functions over moved samples.
  /// \param moved 3 x N, the samples at step 0, relative to \p start.
  /// \param start,step the image k of a sample is its moved position + start + k * step.
  /// \param begin,end steps to add up, in [0, num_steps].
  /// \param[in,out] totals for each function of the table one sum per step.
  void add(const Eigen::Matrix3Xf& moved, const Eigen::Vector3f& start, const Eigen::Vector3f& step, int begin, int end,
           std::vector<std::vector<double>>& totals);

private:
  const LookupTable& table_;
  LineKernel accumulate_;
  CubeInTable cube_;
  std::vector<std::vector<std::int32_t>> sums_;
  std::vector<std::int32_t*> sums_of_;
  std::vector<std::int32_t> storage_;
};

/// The table that the samples are looked up in: f, sharpened for the blur of two boxes, and the free space of a scan.
/// \param visibility null for a whole object.
LookupTable tableOf(const GaussianEdt& edt, const Visibility* visibility, int num_threads);

/// Samples of f in cells from the middle of the cube.
Eigen::Matrix3Xf centeredSamples(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads);

/// A position of the input frame in cells from the middle of the cube.
Eigen::Vector3d toCells(const GaussianEdt& edt, const Eigen::Vector3d& x);

}  // namespace pcl_symmetry
