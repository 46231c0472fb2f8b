#pragma once

#include <array>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// A sample of a surface and its neighborhood.
struct alignas(64) SurfaceSample {
  Eigen::Vector3f point, normal;
  float disc_radius;   ///< of the disc of surface that it represents
  float roughness;     ///< LocalGeometry::roughness
  float normal_trust;  ///< how far the normal means anything, in [0, 1]: noise beyond the spacing leaves none
  std::array<int, kNumWitnesses> nearest;
};

/// The samples of a surface.
class SurfaceSamples {
public:
  /// \param points 3 x N.
  /// \param geometry of the points.
  /// \param num_threads 0 = one per core.
  SurfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads = 1);

  int size() const { return static_cast<int>(samples_.size()); }
  const SurfaceSample& operator[](int i) const { return samples_[static_cast<std::size_t>(i)]; }

private:
  std::vector<SurfaceSample> samples_;
};

/// How far points lie from the surface that samples describe. Each sample represents a disc in its tangent plane; the
/// disc of the closest sample or of one of its four neighbors counts, whichever is nearest.
/// \param points 3 x M, in the frame of the samples.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples N of them.
/// \return M distances >= 0, units of the samples; infinity where no sample is near.
std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples);

/// Distance of each sample from the surface that the others describe: what sampling and noise alone make of a surface
/// that is mapped onto itself.
/// \param samples N >= 2 of them.
/// \param num_threads 0 = one per core.
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads = 1);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

}  // namespace pcl_symmetry
