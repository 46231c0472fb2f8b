#include "core/evidence/surface_samples.h"

#include <algorithm>

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

}  // namespace pcl_symmetry
