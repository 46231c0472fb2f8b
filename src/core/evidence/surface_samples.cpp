#include "core/evidence/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/evidence/evidence_rules.h"

namespace pcl_symmetry {

SurfaceSamples::SurfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads)
    : samples_(static_cast<std::size_t>(points.cols())) {
  parallelRanges(samples_.size(), 2048, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
      const float spacing = geometry.spacing[i], rough = geometry.roughness[i] / std::max(spacing, 1e-6f);
      samples_[static_cast<std::size_t>(i)] = {
          points.col(i),
          geometry.normals.col(i),
          kEvidence.disc_radius * spacing,
          geometry.roughness[i],
          std::clamp((kEvidence.rough_share - rough) / kEvidence.trust_width, 0.0f, 1.0f),
          geometry.nearest[i]};
    }
  });
}

namespace {

/// Squared distance of a point from the disc of a sample.
float sqDistanceFromDisc(const SurfaceSample& sample, const Eigen::Vector3f& point, float across_factor) {
  const Eigen::Vector3f difference = point - sample.point;
  const float across = sample.normal.dot(difference);
  const float along = std::sqrt(std::max(0.0f, difference.squaredNorm() - across * across));
  const float beside = std::max(0.0f, along - sample.disc_radius);
  return across_factor * across_factor * across * across + beside * beside;
}

/// Distance from the nearest of the discs of a sample and its neighbors, but not from that of \p self (-1: none).
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
  parallelRanges(distances.size(), 2048, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      distances[i] = distanceNear(samples[i].nearest[0], i, samples[i].point, samples, kEvidence.new_point_factor);
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
