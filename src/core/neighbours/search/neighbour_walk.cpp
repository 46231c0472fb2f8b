#include "core/neighbours/search/neighbour_walk.h"

#include <limits>

namespace pcl_symmetry {

namespace {

// Cells along each side of the grid where walks begin. chosen: as many as take a hundredth of the time of the search
// for parts; at half, walks are longer, at twice, the grid takes longer to make than it saves.
constexpr int kStartCells = 32;

}  // namespace

NeighbourWalk::NeighbourWalk(const PointsRef& points, const NeighbourLists& lists, const ClosestPointSearch& exact)
    : lists_(lists), exact_(exact), grid_(points, kStartCells) {}

void NeighbourWalk::searchWithin(const PointsRef& queries, float max_sq_distance, std::vector<int>& indices,
                                 std::vector<float>& sq_distances) const {
  sq_distances.resize(indices.size());
  for (Eigen::Index i = 0; i < queries.cols(); ++i) {
    const Eigen::Vector3f query = queries.col(i);
    const NeighbourLists::Answer end =
        lists_.closest(query.data(), indices[i] >= 0 ? indices[i] : grid_.closest(query));
    const bool is_near = end.sq_distance <= max_sq_distance;
    indices[i] = is_near ? end.index : -1;
    sq_distances[i] = is_near ? end.sq_distance : std::numeric_limits<float>::infinity();
  }
}

}  // namespace pcl_symmetry
