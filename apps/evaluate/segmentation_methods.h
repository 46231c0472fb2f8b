/// What an evaluation of segmentations compares, by name.
#pragma once

#include <pcl/PolygonMesh.h>

#include <functional>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// Gives a segment to each face of a mesh.
struct SegmentationMethod {
  std::string name;
  std::function<std::vector<int>(const pcl::PolygonMesh&)> segment;
};

/// Baselines and methods of the library. \param names "one", "k-means". \param num_threads 0 = all.
/// \throws UsageError for an unknown name, with those that are known.
std::vector<SegmentationMethod> segmentationMethods(const std::vector<std::string>& names, int num_threads);

}  // namespace pcl_symmetry::apps
