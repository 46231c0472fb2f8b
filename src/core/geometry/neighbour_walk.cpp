#include "core/geometry/neighbour_walk.h"

#include <limits>

namespace pcl_symmetry {

void NeighbourWalk::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                                 std::vector<float>& sq_distances) const {
  std::vector<char> is_closest(indices.size());
  sq_distances.resize(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] < 0) indices[i] = lists_.start(queries.col(static_cast<Eigen::Index>(i)));
  lists_.walk(queries, indices.data(), sq_distances.data(), is_closest.data());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (sq_distances[i] <= max_sq_distance) continue;
    indices[i] = -1;
    sq_distances[i] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace pcl_symmetry
