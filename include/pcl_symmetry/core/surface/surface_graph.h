#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A surface as elements with neighbours: the faces of a mesh or the points of a cloud.
struct SurfaceGraph {
  /// A stretch of border between two elements.
  struct Edge {
    int from, to;
    float length;     ///< of the border, input units
    float concavity;  ///< angle between the normals, radians, > 0 where the surface is concave, < 0 where it is convex
  };

  Points centers;            ///< 3 x N
  Points normals;            ///< 3 x N, unit, outward; zero where an element has none
  std::vector<float> areas;  ///< N, input units squared
  std::vector<Edge> edges;
  std::vector<int> first_edge;  ///< N + 1, into edge_of
  std::vector<int> edge_of;     ///< indices into edges, element by element

  /// The surface for rays and samples: triangles of the elements; small ones about the points of a cloud.
  Points corners;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> element_of_triangle;
  bool is_cloud = false;  ///< elements are points

  int size() const { return static_cast<int>(areas.size()); }
  double area() const;

  /// Calls visit(neighbour, edge) for each neighbour of an element.
  template <typename Visit>
  void visitNeighbours(int element, const Visit& visit) const {
    for (int i = first_edge[element]; i < first_edge[element + 1]; ++i) {
      const Edge& edge = edges[edge_of[i]];
      visit(edge.from == element ? edge.to : edge.from, edge);
    }
  }
};

/// Faces joined where they share an edge. Corners at the same place are one, so that a polygon soup is connected; edges
/// of more than two faces join each with the next; faces without area have neighbours too.
/// \param vertices 3 x V. \param polygons indices into the vertices, three or more each; those with a vertex that is
/// not finite are elements without neighbours. \throws std::invalid_argument where an index is out of range or no
/// polygon has an area.
SurfaceGraph meshGraph(const PointsRef& vertices, const std::vector<std::vector<int>>& polygons);

/// Points joined with their neighbours.
/// \param points 3 x N, finite, not all equal. \param neighbours of each point the closest others, nearest first, the
/// same number for all. \throws std::invalid_argument for points without extent.
SurfaceGraph cloudGraph(const PointsRef& points, const std::vector<std::vector<int>>& neighbours);

/// Numbers from 0 for the connected pieces of equal label, in the order of their first elements.
/// \param labels one per element; elements with a label < 0 belong to no piece and get -1.
std::vector<int> connectedPieces(const SurfaceGraph& graph, const std::vector<int>& labels);

}  // namespace pcl_symmetry
