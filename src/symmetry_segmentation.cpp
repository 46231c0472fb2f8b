#include "pcl_symmetry/symmetry_segmentation.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/curve_order.h"
#include "core/geometry/point_samples.h"
#include "mesh_conversion.h"

namespace pcl_symmetry {

bool detail::hasArea(const pcl::PolygonMesh& mesh) {
  return pcl_symmetry::hasArea(toArrays(mesh));
}

std::vector<std::vector<int>> detail::nearestOthers(const Points& points, const ClosestPointSearch& search,
                                                    int num_neighbors, int num_threads) {
  const auto size = static_cast<std::size_t>(points.cols());
  const std::size_t num_others = std::min<std::size_t>(num_neighbors, size - 1), num_found = num_others + 1;
  std::vector<std::vector<int>> neighbors(size);
  const std::vector<int> order = curveOrder(points);  // a search finds the neighbors of near points together
  parallelRanges(size, 1024, num_threads, [&](std::size_t begin, std::size_t end) {
    const std::vector<int> block(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                 order.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<int> found;
    std::vector<float> sq_distances;
    search.search(pointsAt(points, block), static_cast<int>(num_found), found, sq_distances);
    for (std::size_t i = 0; i < block.size(); ++i) {
      std::vector<int>& others = neighbors[static_cast<std::size_t>(block[i])];
      for (std::size_t k = i * num_found; k < (i + 1) * num_found; ++k)
        if (found[k] != block[i] && others.size() < num_others) others.push_back(found[k]);
    }
  });
  return neighbors;
}

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  const MeshArrays arrays = toArrays(mesh);
  return meshGraph(arrays.vertices, arrays.polygons);
}

}  // namespace pcl_symmetry
