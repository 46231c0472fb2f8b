#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

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
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads = 1);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

/// A cloud in two halves: how much of one half lies on the surface that the other describes.
///
/// Where noise exceeds the spacing, a point and the surface that was fitted to it are not independent, and no
/// correction for that holds. The reflection of one half by a true plane is a new sample of the same noisy surface as
/// the other half and lies on it exactly as often as the half itself.
class SplitSurface {
public:
  /// \param points 3 x N, finite, N >= 4.
  /// \param seed of the halves.
  SplitSurface(const Points& points, std::uint64_t seed, int num_threads);

  /// \return distances of the first half from the surface of the second, units of the points, >= 0.
  std::vector<float> ownDistances() const { return distances(first_); }
  /// \return the same for the reflections of the first half.
  std::vector<float> reflectedDistances(const ReflectionPlane& plane) const;

  /// What sampling and noise leave of D of equation 2 for a true plane: f of all points and f of their reflections
  /// differ by noise alone. Halves of the points differ by noise, too, but they are half as dense, and quarters are
  /// half as dense as halves: what D loses falls by the same factor with each doubling of the points.
  /// \param num_cells,sigma of the distance transform that D is computed from; sigma in units of the points.
  /// \param ball that it covers, frame of the points.
  /// \return in [0.5, 1].
  double ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const;

private:
  std::vector<float> distances(const Points& points) const;

  std::uint64_t seed_;
  Points first_, second_;
  ClosestPointSearch::Ptr search_;         ///< of the second half
  std::optional<SurfaceSamples> samples_;  ///< the second half
};

}  // namespace pcl_symmetry
