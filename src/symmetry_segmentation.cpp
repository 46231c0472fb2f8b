#include "pcl_symmetry/symmetry_segmentation.h"

#include <algorithm>

#include "mesh_conversion.h"

namespace pcl_symmetry {

bool detail::hasArea(const pcl::PolygonMesh& mesh) {
  return pcl_symmetry::hasArea(toArrays(mesh));
}

std::vector<std::vector<int>> detail::nearestOthers(const Points& points, int num_neighbors) {
  const auto size = static_cast<std::size_t>(points.cols());
  const std::size_t num_others = std::min<std::size_t>(num_neighbors, size - 1), num_found = num_others + 1;
  std::vector<int> found;
  std::vector<float> sq_distances;
  makeTreeSearch(points)->search(points, static_cast<int>(num_found), found, sq_distances);
  std::vector<std::vector<int>> neighbors(size);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t k = i * num_found; k < (i + 1) * num_found; ++k)
      if (static_cast<std::size_t>(found[k]) != i && neighbors[i].size() < num_others) neighbors[i].push_back(found[k]);
  return neighbors;
}

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  const MeshArrays arrays = toArrays(mesh);
  return meshGraph(arrays.vertices, arrays.polygons);
}

}  // namespace pcl_symmetry
