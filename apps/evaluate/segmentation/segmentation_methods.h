/// What an evaluation of segmentations compares, by name.
#pragma once

#include <pcl/PolygonMesh.h>

#include <functional>
#include <string>
#include <vector>

#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry::apps {

/// Gives a segment to each face of a mesh; baselines fill the labels alone.
struct NamedSegmentation {
  std::string name;
  std::function<Segmentation(const pcl::PolygonMesh&)> segment;
};

/// Baselines, methods of the library, and the default without one of its steps.
/// \param names as `pcl_symmetry_evaluate segmentation -h` lists them.
/// \param num_threads 0 = all.
/// \throws UsageError for an unknown name, with those that are known.
std::vector<NamedSegmentation> segmentationMethods(const std::vector<std::string>& names, int num_threads);

}  // namespace pcl_symmetry::apps
