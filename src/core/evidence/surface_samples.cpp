#include "core/evidence/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace pcl_symmetry {

namespace {

// Roughness in spacings at which normals mean nothing, and below which by 0.1 they count in full. chosen: between the
// roughness of clean surfaces and that of volumes (0.42); smaller values ignore the normals of slightly noisy surfaces.
constexpr float kRoughShare = 0.25f, kTrustWidth = 0.1f;
constexpr float kLeastSpacing = 1e-6f;  // radii. derived: rounding of coordinates about 1; avoids a division by 0
constexpr std::size_t kSamplesPerBlock = 2048;  // chosen: large enough that threads start seldom

}  // namespace

SurfaceSamples::SurfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads)
    : samples_(static_cast<std::size_t>(points.cols())) {
  parallelRanges(samples_.size(), kSamplesPerBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
      const float spacing = geometry.spacing[i], rough = geometry.roughness[i] / std::max(spacing, kLeastSpacing);
      samples_[static_cast<std::size_t>(i)] = {points.col(i),
                                               geometry.normals.col(i),
                                               kDiscRadius * spacing,
                                               geometry.roughness[i],
                                               std::clamp((kRoughShare - rough) / kTrustWidth, 0.0f, 1.0f),
                                               geometry.nearest[i]};
    }
  });
}

namespace {

// How much farther off a plane a new point lies than one of the nine points that the plane was fitted to.
// derived: with p = 3 parameters and n = 9 points the leverage is l = p / n, residuals of the points have the variance
// (1 - l) and those of new points (1 + l) times that of the noise; the root of their ratio.
constexpr float kNewPointFactor = 1.41421356f;
constexpr std::size_t kDistancesPerBlock = 2048;  // chosen: large enough that threads start seldom

/// Squared distance of a point from the disc of a sample.
float sqDistanceFromDisc(const SurfaceSample& sample, const Eigen::Vector3f& point, float across_factor) {
  const Eigen::Vector3f difference = point - sample.point;
  const float across = sample.normal.dot(difference);
  const float along = std::sqrt(std::max(0.0f, difference.squaredNorm() - across * across));
  const float beside = std::max(0.0f, along - sample.disc_radius);
  return across_factor * across_factor * across * across + beside * beside;
}

/// Distance from the nearest of the discs of a sample and its neighbours, but not from that of \p self (-1: none).
float distanceNear(int closest, int self, const Eigen::Vector3f& point, const SurfaceSamples& samples,
                   float across_factor) {
  float least = sqDistanceFromDisc(samples[closest], point, across_factor);
  for (const int j : samples[closest].nearest)
    if (j != self) least = std::min(least, sqDistanceFromDisc(samples[j], point, across_factor));
  return std::sqrt(least);
}

}  // namespace

std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples) {
  std::vector<float> distances(closest.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < closest.size(); ++i)
    if (closest[i] >= 0) distances[i] = distanceNear(closest[i], -1, points.col(i), samples, 1.0f);
  return distances;
}

std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads) {
  std::vector<float> distances(static_cast<std::size_t>(samples.size()));
  parallelRanges(distances.size(), kDistancesPerBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      distances[i] = distanceNear(samples[i].nearest[0], i, samples[i].point, samples, kNewPointFactor);
  });
  return distances;
}

double shareWithin(const std::vector<float>& distances, double tolerance) {
  const auto limit = static_cast<float>(tolerance);
  const auto count =
      std::count_if(distances.begin(), distances.end(), [&](float distance) { return distance <= limit; });
  return static_cast<double>(count) / static_cast<double>(distances.size());
}

}  // namespace pcl_symmetry
