#pragma once

#include <array>
#include <vector>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

/// So many samples next to the closest one are asked whether a point lies on the surface: of those within reach (1.25
/// spacings) there are five on average.
constexpr int kNumWitnesses = 4;

/// What the neighbourhood of each point of a cloud says about the surface it was sampled from.
struct LocalGeometry {
  Points normals;                ///< 3 x N, unit, of any sign
  std::vector<float> roughness;  ///< N, root mean square distance of the neighbours from the tangent plane
  std::vector<char> at_border;   ///< N, 1 where the neighbours lie to one side: the rim of a scan, or a sharp edge
  /// N, the closest other samples, nearest first (itself where there are no more)
  std::vector<std::array<int, kNumWitnesses>> nearest;
  /// N, 1 / sqrt(density): the distance at which a surface sample has 1 / pi of a neighbour
  std::vector<float> spacing;
};

/// Neighbours that normals and spacing are taken from: the fewest that keep the error of the spacing below 20 %.
constexpr int kNumSupportNeighbours = 8;

/// Normals by PCA of the nearest neighbours, and the local spacing of the samples from the distance r_k to the k-th of
/// them: a surface of density rho has k = pi rho r_k^2 neighbours within r_k.
/// \param num_neighbours >= 3; clouds with fewer points use all they have.
LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_neighbours,
                            int num_threads);

/// LocalGeometry::roughness at a few places of the surface.
/// \param places 3 x M, among \p points. \return M values.
std::vector<float> localRoughness(const Points& points, const ClosestPointSearch& search, const Points& places,
                                  int num_neighbours = kNumSupportNeighbours);

}  // namespace pcl_symmetry
