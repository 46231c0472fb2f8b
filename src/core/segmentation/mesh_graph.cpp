#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "core/base/check.h"
#include "core/geometry/distinct_points.h"
#include "core/segmentation/graph_completion.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

namespace {

using Polygons = std::vector<std::vector<int>>;

/// The polygons on welded vertices; a polygon with a vertex that is not finite becomes empty.
Polygons weldedPolygons(const PointsRef& vertices, const Polygons& polygons) {
  const std::vector<int> welded = firstCopies(vertices);
  Polygons faces(polygons.size());
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    for (const int v : polygons[f]) {
      check(v >= 0 && v < vertices.cols(), "vertex of a polygon", v, "an index of a vertex");
      faces[f].push_back(welded[v]);
    }
    if (!vertices(Eigen::all, polygons[f]).allFinite()) faces[f].clear();
  }
  return faces;
}

/// Divides the faces into fans of triangles.
void addTriangles(SurfaceGraph& graph, const Polygons& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 2; k < faces[f].size(); ++k) {
      graph.triangles.emplace_back(faces[f][0], faces[f][k - 1], faces[f][k]);
      graph.element_of_triangle.push_back(static_cast<int>(f));
    }
  }
}

/// Measures area, normal and area-weighted center of each face. A face without area gets the mean of its vertices.
void measureFaces(SurfaceGraph& graph, const Polygons& faces) {
  const auto size = static_cast<Eigen::Index>(faces.size());
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, size), centers = normals, means = normals;
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(size);
  for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return graph.corners.col(graph.triangles[t][k]).cast<double>();
    };
    const Eigen::Vector3d normal = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const int element = graph.element_of_triangle[t];
    normals.col(element) += normal;
    centers.col(element) += normal.norm() / 3.0 * (corner(0) + corner(1) + corner(2));
    areas[element] += normal.norm();
  }
  for (Eigen::Index f = 0; f < size; ++f) {
    for (const int v : faces[f]) means.col(f) += graph.corners.col(v).cast<double>();
    if (areas[f] > 0.0)
      centers.col(f) /= areas[f];
    else if (!faces[f].empty())
      centers.col(f) = means.col(f) / static_cast<double>(faces[f].size());
    if (!centers.col(f).allFinite()) centers.col(f).setZero();
    normals.col(f) = normals.col(f).stableNormalized();
    if (!normals.col(f).allFinite()) normals.col(f).setZero();
  }
  graph.centers = centers.cast<float>();
  graph.normals = normals.cast<float>();
  graph.areas.resize(static_cast<std::size_t>(size));
  for (Eigen::Index f = 0; f < size; ++f) graph.areas[f] = static_cast<float>(areas[f]);
}

/// A face at an edge of the mesh.
struct FaceAtEdge {
  int face;
  bool upwards;  ///< whether the face runs from the lower to the higher index of the two vertices
};
using FacesOfEdges = std::map<std::pair<int, int>, std::vector<FaceAtEdge>>;

FacesOfEdges facesOfEdges(const Polygons& faces) {
  FacesOfEdges faces_of_edge;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % faces[f].size()];
      if (a == b) continue;
      std::vector<FaceAtEdge>& sharing = faces_of_edge[std::minmax(a, b)];
      if (sharing.empty() || sharing.back().face != static_cast<int>(f))
        sharing.push_back({static_cast<int>(f), a < b});
    }
  }
  return faces_of_edge;
}

/// Joins each face at an edge with the next one.
/// \return the agreement of the two normals: faces of one orientation run through their edge in opposite directions.
std::vector<float> joinFaces(SurfaceGraph& graph, const FacesOfEdges& faces_of_edge) {
  std::vector<float> agreement;
  for (const auto& [ends, sharing] : faces_of_edge) {
    const float length = (graph.corners.col(ends.first) - graph.corners.col(ends.second)).norm();
    for (std::size_t i = 1; i < sharing.size(); ++i) {
      graph.edges.push_back({sharing[i - 1].face, sharing[i].face, length, 0.0f});
      agreement.push_back(sharing[i - 1].upwards != sharing[i].upwards ? 1.0f : -1.0f);
    }
  }
  return agreement;
}

}  // namespace

SurfaceGraph meshGraph(const PointsRef& vertices, const Polygons& polygons) {
  checkExtent(vertices);
  const Polygons faces = weldedPolygons(vertices, polygons);
  SurfaceGraph graph;
  graph.corners = vertices;
  addTriangles(graph, faces);
  measureFaces(graph, faces);
  check(graph.area() > 0.0, "area of the mesh", graph.area(), "> 0");
  const std::vector<float> agreement = joinFaces(graph, facesOfEdges(faces));
  return completedGraph(std::move(graph), agreement);
}

}  // namespace pcl_symmetry
