/// Ways in which the points of a whole cloud are spread over a mesh.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <array>
#include <cstdint>

#include "common/scanner/virtual_scanner.h"

namespace pcl_symmetry::apps {

enum class SamplingPattern {
  Even,      ///< one point in each of equal shares of the area
  Random,    ///< drawn from an even sample 20 times as dense: clusters and gaps, as of independent points
  Voxel,     ///< means of the points of a dense sample in cells of one size
  Scanners,  ///< drawn from depth pictures from the eight corners of a cube: dense where the surface faces a scanner,
             ///< and without what no scanner sees
  Rings      ///< every eighth row of depth pictures from the corners: lines of points, as of a spinning LiDAR
};

/// derived: all but Even.
constexpr std::array<SamplingPattern, 4> kSamplingPatterns{SamplingPattern::Random, SamplingPattern::Voxel,
                                                           SamplingPattern::Scanners, SamplingPattern::Rings};

const char* toString(SamplingPattern pattern);

/// \param scanner of the same mesh.
/// \param num_points wanted; Voxel gives within 2 % of it, the others no more.
/// \return in the mesh's frame, unorganized, without a viewpoint.
/// \throws std::runtime_error where a scanner sees nothing.
pcl::PointCloud<pcl::PointXYZ>::Ptr samplePattern(const pcl::PolygonMesh& mesh, const VirtualScanner& scanner,
                                                  SamplingPattern pattern, int num_points, std::uint64_t seed);

}  // namespace pcl_symmetry::apps
