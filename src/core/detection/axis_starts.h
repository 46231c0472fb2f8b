#pragma once

#include <cstdint>
#include <vector>

#include "core/detection/turn_evidence.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// A line that may be an axis, and the order that it may have; 0: any angle.
struct AxisStart {
  Line3d line;
  int fold;
};

/// Lines that many normals of a scan meet or are parallel to: the best of all, and the best of small draws, so that a
/// base or a handle does not decide.
/// \param seed of the draws.
/// \param num_threads 0 = one per core.
std::vector<AxisStart> startsFromNormals(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads);

/// Common lines of planes at an angle of k pi / n.
/// \param planes normalised frame.
/// \param max_fold greatest n, >= 2.
std::vector<AxisStart> startsFromPlanes(const std::vector<ReflectionPlane>& planes, int max_fold);

/// Maxima of an axial transform with few bins and the free space of the scan.
std::vector<AxisStart> startsFromTransform(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads);

}  // namespace pcl_symmetry
