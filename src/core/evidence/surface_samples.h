#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/surface_discs.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// A sample of a surface, the disc of surface that it represents, and its neighborhood.
struct alignas(64) SurfaceSample : SurfaceDisc {
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
                                    const SurfaceSamples& samples, int num_threads = 1);

/// Distance of each sample from the surface that the others describe: what sampling and noise alone make of a surface
/// that is mapped onto itself.
/// \param samples N >= 2 of them.
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads = 1);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

/// Evidence of each of M reflected points, in [0, 1].
struct PointEvidence {
  std::vector<float> support;   ///< the reflection lies on the surface
  std::vector<float> conflict;  ///< the reflection lies where the scanner saw that there is nothing
};

/// How surely a point lies in free space. A pixel without a depth means free space where the sensor is exact, and
/// little where it has errors: it may be a shadow of the projector, or an occluder may have been cut out of the
/// picture.
/// \param x in the unit ball.
/// \return in [0, 1]: 0 behind what was seen, 1 before it.
float emptiness(const Visibility& visibility, const Eigen::Vector3d& x);

/// How well single points of a surface support a reflection (the white regions of Figure 8). Near an edge the closest
/// sample may lie on another face: the best of that sample and of those next to it counts.
///
/// Departure from the paper, which measures the distance of the reflected point by the Gaussian of the transform: here
/// the unit is the distance between samples, so that the result needs no length in input units. A reflected point that
/// lies on the surface is farther from the closest sample than 1.25 spacings in 1 of 135 cases (spacing = 1 /
/// sqrt(density), measured at that sample). Up to there the support is 1; beyond, it falls as a Gaussian.
/// \param reflected 3 x M, reflections of points of the surface, normalized to the unit ball.
/// \param reflected_normals 3 x M, reflections of their normals.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples the surface, in the same frame.
/// \param visibility what a scanner saw, in the same frame; null = the samples show the object from all sides.
PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const SurfaceSamples& samples, const Visibility* visibility, int num_threads = 1);

/// Support of each sample on the surface that the other samples describe: what sampling alone leaves of a symmetry.
/// \param samples N, normalized to the unit ball.
/// \return N values in [0, 1].
std::vector<float> ownSupport(const SurfaceSamples& samples, int num_threads);

/// \param support at least one value.
/// \return the mean.
double meanSupport(const std::vector<float>& support);

/// Support of each of \p points for planes, on the surface that \p samples describe.
/// \param points 3 x M, finite.
/// \param samples 3 x N, finite, not all equal, in the same frame.
/// \param planes in the same frame.
/// \return for each plane M values in [0, 1].
/// \throws std::invalid_argument where all samples coincide.
std::vector<std::vector<float>> planeSupport(const PointsRef& points, const PointsRef& samples,
                                             const std::vector<ReflectionPlane>& planes, int num_threads = 0);

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
