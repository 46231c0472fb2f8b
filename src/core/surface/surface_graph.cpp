#include "pcl_symmetry/core/surface/surface_graph.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/check.h"
#include "core/neighbours/surface_normals.h"
#include "core/surface/orientation.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// For each vertex the first one at the same place; -1 where it is not finite.
std::vector<int> weld(const PointsRef& vertices) {
  std::vector<int> order(vertices.cols());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::array<float, 3>{vertices(0, i), vertices(1, i), vertices(2, i)}; };
  order.erase(std::remove_if(order.begin(), order.end(), [&](int i) { return !vertices.col(i).allFinite(); }),
              order.end());
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> first(vertices.cols(), -1);
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

void addTriangles(SurfaceGraph& graph, int element, const std::vector<int>& polygon) {
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    graph.triangles.emplace_back(polygon[0], polygon[k - 1], polygon[k]);
    graph.element_of_triangle.push_back(element);
  }
}

/// Center by area, normal and area of each element from its triangles.
void measureElements(SurfaceGraph& graph, const std::vector<std::vector<int>>& polygons) {
  const auto size = static_cast<Eigen::Index>(polygons.size());
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
    for (const int v : polygons[f]) means.col(f) += graph.corners.col(v).cast<double>();
    if (areas[f] > 0.0)
      centers.col(f) /= areas[f];
    else if (!polygons[f].empty())
      centers.col(f) = means.col(f) / static_cast<double>(polygons[f].size());
    if (!centers.col(f).allFinite()) centers.col(f).setZero();
    normals.col(f) = normals.col(f).stableNormalized();
    if (!normals.col(f).allFinite()) normals.col(f).setZero();
  }
  graph.centers = centers.cast<float>();
  graph.normals = normals.cast<float>();
  graph.areas.resize(static_cast<std::size_t>(size));
  for (Eigen::Index f = 0; f < size; ++f) graph.areas[f] = static_cast<float>(areas[f]);
}

/// The list of edges, element by element.
void indexEdges(SurfaceGraph& graph) {
  graph.first_edge.assign(static_cast<std::size_t>(graph.size()) + 1, 0);
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    ++graph.first_edge[edge.from + 1];
    ++graph.first_edge[edge.to + 1];
  }
  std::partial_sum(graph.first_edge.begin(), graph.first_edge.end(), graph.first_edge.begin());
  graph.edge_of.resize(2 * graph.edges.size());
  std::vector<int> next(graph.first_edge.begin(), graph.first_edge.end() - 1);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    graph.edge_of[next[graph.edges[e].from]++] = static_cast<int>(e);
    graph.edge_of[next[graph.edges[e].to]++] = static_cast<int>(e);
  }
}

/// Angle between the normals at both ends of each edge, with its sign.
void measureConcavity(SurfaceGraph& graph) {
  for (SurfaceGraph::Edge& edge : graph.edges) {
    const Eigen::Vector3f a = graph.normals.col(edge.from), b = graph.normals.col(edge.to);
    const float angle = std::atan2(a.cross(b).norm(), a.dot(b));
    const float opening = (a - b).dot(graph.centers.col(edge.to) - graph.centers.col(edge.from));
    edge.concavity = opening > 0.0f ? angle : -angle;
  }
}

}  // namespace

double SurfaceGraph::area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

SurfaceGraph meshGraph(const PointsRef& vertices, const std::vector<std::vector<int>>& polygons) {
  SurfaceGraph graph;
  const std::vector<int> welded = weld(vertices);
  graph.corners = vertices;
  std::vector<std::vector<int>> faces(polygons.size());
  // A face at an edge, and whether it runs through the edge upwards: faces of one orientation run in opposite ways.
  using Sharing = std::pair<int, bool>;
  std::map<std::pair<int, int>, std::vector<Sharing>> faces_of_edge;
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    for (const int v : polygons[f]) {
      check(v >= 0 && v < vertices.cols(), "vertex of a polygon", v, "a vertex");
      faces[f].push_back(welded[v]);
    }
    if (std::find(faces[f].begin(), faces[f].end(), -1) != faces[f].end()) faces[f].clear();
    addTriangles(graph, static_cast<int>(f), faces[f]);
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % faces[f].size()];
      if (a == b) continue;
      std::vector<Sharing>& sharing = faces_of_edge[std::minmax(a, b)];
      if (sharing.empty() || sharing.back().first != static_cast<int>(f))
        sharing.emplace_back(static_cast<int>(f), a < b);
    }
  }
  measureElements(graph, faces);
  check(graph.area() > 0.0, "area of the mesh", graph.area(), "> 0");
  std::vector<float> agreement;
  for (const auto& [ends, sharing] : faces_of_edge) {
    const float length = (vertices.col(ends.first) - vertices.col(ends.second)).norm();
    for (std::size_t i = 1; i < sharing.size(); ++i) {
      graph.edges.push_back({sharing[i - 1].first, sharing[i].first, length, 0.0f});
      agreement.push_back(sharing[i - 1].second != sharing[i].second ? 1.0f : -1.0f);
    }
  }
  indexEdges(graph);
  orientNormals(graph, agreement);
  measureConcavity(graph);
  return graph;
}

SurfaceGraph cloudGraph(const PointsRef& points, const std::vector<std::vector<int>>& neighbours) {
  SurfaceGraph graph;
  graph.is_cloud = true;
  graph.centers = points;
  const auto size = points.cols();
  const BoundingBall ball = boundingBall(points);
  check(ball.radius > 0.0, "extent of the points", ball.radius, "> 0");
  graph.normals.resize(3, size);
  graph.areas.resize(static_cast<std::size_t>(size));
  graph.corners.resize(3, 3 * size);
  for (Eigen::Index i = 0; i < size; ++i) {
    Points around(3, static_cast<Eigen::Index>(neighbours[i].size()) + 1);
    around.col(0) = points.col(i);
    for (std::size_t k = 0; k < neighbours[i].size(); ++k)
      around.col(static_cast<Eigen::Index>(k) + 1) = points.col(neighbours[i][k]);
    const Points offsets = around.colwise() - around.rowwise().mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(offsets * offsets.transpose());
    graph.normals.col(i) = axes.eigenvectors().col(0);
    // k neighbours within the distance r of the last: an area of pi r^2 / k each.
    const auto count = static_cast<float>(neighbours[i].size());
    const float radius = (around.rightCols(1) - around.col(0)).norm();
    graph.areas[i] = static_cast<float>(M_PI) * radius * radius / std::max(1.0f, count);
    // A triangle whose incircle covers that area about the point.
    const float circumradius = 2.0f * std::sqrt(graph.areas[i] / static_cast<float>(M_PI));
    const Eigen::Vector3f u = axes.eigenvectors().col(1), v = axes.eigenvectors().col(2);
    for (int k = 0; k < 3; ++k) {
      const float angle = static_cast<float>(2.0 * M_PI * k / 3.0);
      graph.corners.col(3 * i + k) = points.col(i) + circumradius * (std::cos(angle) * u + std::sin(angle) * v);
    }
    const int first = static_cast<int>(3 * i);
    graph.triangles.emplace_back(first, first + 1, first + 2);
    graph.element_of_triangle.push_back(static_cast<int>(i));
    for (const int j : neighbours[i]) {
      const bool mutual = std::find(neighbours[j].begin(), neighbours[j].end(), i) != neighbours[j].end();
      if (mutual && j < i) continue;
      // Of k neighbours each borders on 1 / k of the circle around the area of a point.
      const float length = 2.0f * std::sqrt(static_cast<float>(M_PI) * graph.areas[i]) / std::max(1.0f, count);
      graph.edges.push_back({static_cast<int>(i), j, length, 0.0f});
    }
  }
  check(graph.area() > 0.0, "area of the cloud", graph.area(), "> 0");
  std::vector<float> agreement;
  for (const SurfaceGraph::Edge& edge : graph.edges)
    agreement.push_back(graph.normals.col(edge.from).dot(graph.normals.col(edge.to)));
  indexEdges(graph);
  orientNormals(graph, agreement);
  measureConcavity(graph);
  return graph;
}

std::vector<int> connectedPieces(const SurfaceGraph& graph, const std::vector<int>& labels) {
  std::vector<int> pieces(labels.size(), -1), stack;
  int num_pieces = 0;
  for (int start = 0; start < graph.size(); ++start) {
    if (pieces[start] >= 0 || labels[start] < 0) continue;
    pieces[start] = num_pieces;
    stack.push_back(start);
    while (!stack.empty()) {
      const int element = stack.back();
      stack.pop_back();
      graph.visitNeighbours(element, [&](int neighbour, const SurfaceGraph::Edge&) {
        if (pieces[neighbour] >= 0 || labels[neighbour] != labels[start]) return;
        pieces[neighbour] = num_pieces;
        stack.push_back(neighbour);
      });
    }
    ++num_pieces;
  }
  return pieces;
}

}  // namespace pcl_symmetry
