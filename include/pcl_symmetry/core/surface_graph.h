#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A surface as N elements with neighbors (Section 5.3): the faces of a mesh or the points of a cloud.
struct SurfaceGraph {
  /// Two neighboring elements and the border that they share.
  struct Edge {
    int from;      ///< element, in [0, N)
    int to;        ///< element, in [0, N)
    float length;  ///< length of the border, input units
    /// Angle between the two normals, in [-pi, pi] radians; > 0 where the surface is concave. For points it is 1.5
    /// times the angle, because their normals are averages over neighbors.
    float concavity;
  };

  Points centers;               ///< 3 x N, input frame
  Points normals;               ///< 3 x N, unit, outward; zero for an element without a normal
  std::vector<float> areas;     ///< N, input units squared, >= 0
  std::vector<Edge> edges;      ///< each pair of neighbors once
  std::vector<int> first_edge;  ///< N + 1 indices into edge_of: where the edges of each element begin
  std::vector<int> edge_of;     ///< indices into edges, element by element

  Points corners;                          ///< 3 x C, vertices of the triangles
  std::vector<Eigen::Vector3i> triangles;  ///< faces in triangles, or one small triangle for each point of a cloud
  std::vector<int> element_of_triangle;    ///< one per triangle, in [0, N)
  bool is_cloud = false;                   ///< whether the elements are points

  /// \return N.
  int size() const { return static_cast<int>(areas.size()); }

  /// \return the total area, input units squared.
  double area() const;

  /// Calls visit(neighbor, edge) for each neighbor of an element.
  /// \param element in [0, N).
  /// \param visit takes (int, const Edge&).
  template <typename Visit>
  void visitNeighbors(int element, const Visit& visit) const {
    for (int i = first_edge[element]; i < first_edge[element + 1]; ++i) {
      const Edge& edge = edges[edge_of[i]];
      visit(edge.from == element ? edge.to : edge.from, edge);
    }
  }
};

/// The graph of a mesh: faces are neighbors if they share an edge.
///
/// Vertices at the same position are joined, so that a polygon soup is connected. If more than two faces share an edge,
/// each is joined with the next one. Faces without area have neighbors, too.
/// \param vertices 3 x V, input frame.
/// \param polygons three or more indices into the vertices each. A polygon with a vertex that is not finite becomes an
/// element without neighbors.
/// \return one element per polygon, in input order.
/// \throws std::invalid_argument if an index is out of range, no polygon has an area, or the extent is not 1e-15 to
/// 1e15.
SurfaceGraph meshGraph(const PointsRef& vertices, const std::vector<std::vector<int>>& polygons);

/// The graph of a cloud: two points are neighbors if one of them is among the nearest of the other.
/// \param points 3 x N, finite, input frame.
/// \param neighbors for each point the indices of its nearest other points, nearest first; the same number for all.
/// \return one element per point, in input order; the area is estimated from the distance of the last neighbor.
/// \throws std::invalid_argument if all points are equal, their extent is not 1e-15 to 1e15, or a neighbor is missing.
SurfaceGraph cloudGraph(const PointsRef& points, const std::vector<std::vector<int>>& neighbors);

/// Connected pieces of equal label.
/// \param graph N elements.
/// \param labels N values; an element with a label < 0 belongs to no piece.
/// \return the number of its piece for each element, counted from 0 in the order of the first elements; -1 for none.
std::vector<int> connectedPieces(const SurfaceGraph& graph, const std::vector<int>& labels);

}  // namespace pcl_symmetry
