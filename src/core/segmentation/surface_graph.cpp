#include "pcl_symmetry/core/surface_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/triangles.h"
#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

constexpr double kMinExtent = 1e-15;  // input units; squares and sums stay within float
constexpr double kGreatestExtent = 1e15;

/// Throws for points whose distances have no squares in float: areas and neighbors would be infinite or zero.
/// \param points 3 x N; those that are not finite do not count.
/// \throws std::invalid_argument naming the extent and the rule.
void checkExtent(const PointsRef& points) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite()) box.extend(Eigen::Vector3d(points.col(i).cast<double>()));
  const double extent = box.isEmpty() ? 0.0 : box.diagonal().norm();
  check(extent == 0.0 || extent >= kMinExtent, "extent of the points", extent, ">= 1e-15");
  check(extent <= kGreatestExtent, "extent of the points", extent, "<= 1e15");
}

/// Orients normals so that neighbors agree, along the most certain edges first (Hoppe et al. 1992).
Points alignNeighbors(const SurfaceGraph& graph, const std::vector<float>& agreement) {
  struct Entry {
    float certainty;
    int element;
    float sign;
    bool operator<(const Entry& other) const { return certainty < other.certainty; }
  };
  Points normals = graph.normals;
  std::vector<char> is_aligned(graph.size(), 0);
  std::priority_queue<Entry> queue;
  for (int start = 0; start < graph.size(); ++start) {
    queue.push({1.0f, start, 1.0f});
    while (!queue.empty()) {
      const Entry next = queue.top();
      queue.pop();
      if (is_aligned[next.element]) continue;
      is_aligned[next.element] = 1;
      normals.col(next.element) *= next.sign;
      graph.visitNeighbors(next.element, [&](int neighbor, const SurfaceGraph::Edge& edge) {
        const float agrees = agreement[&edge - graph.edges.data()];
        if (!is_aligned[neighbor]) queue.push({std::abs(agrees), neighbor, agrees < 0.0f ? -next.sign : next.sign});
      });
    }
  }
  return normals;
}

/// The elements of each connected piece.
std::vector<std::vector<int>> membersOfPieces(const SurfaceGraph& graph) {
  const std::vector<int> piece = connectedPieces(graph, std::vector<int>(static_cast<std::size_t>(graph.size()), 0));
  std::vector<std::vector<int>> members;
  for (int i = 0; i < graph.size(); ++i) {
    if (piece[i] == static_cast<int>(members.size())) members.emplace_back();
    members[piece[i]].push_back(i);
  }
  return members;
}

/// Area of the elements whose rays along the normal leave the shape, minus the area of the elements whose rays against
/// the normal do.
double escapingArea(const SurfaceGraph& graph, const Points& normals, const TriangleTree& tree,
                    const std::vector<int>& members, RandomStream& random) {
  const int num_rays = static_cast<int>(std::min<std::size_t>(members.size(), kSegmentation.orientation_rays));
  double escaped = 0.0;
  for (int k = 0; k < num_rays; ++k) {
    const int element = members[members.size() * k / num_rays];
    const Eigen::Vector3f n = normals.col(element), center = graph.centers.col(element);
    const float reach = kSegmentation.ray_start * std::sqrt(graph.areas[element]);
    Eigen::Vector3f direction;
    for (int axis = 0; axis < 3; ++axis) direction[axis] = static_cast<float>(random.uniform() - 0.5);
    direction = (n + direction).normalized();
    const bool out = tree.closest(center, direction, reach).triangle < 0;
    const bool in = tree.closest(center, Eigen::Vector3f(-direction), reach).triangle < 0;
    escaped += graph.areas[element] * (static_cast<double>(out) - static_cast<double>(in));
  }
  return escaped;
}

/// Outward normals: neighbors agree, and rays along the normals of a connected piece leave the shape more often than
/// rays against them.
/// \param graph with normals of any sign and with the index of its edges.
/// \return 3 x N, each normal of the graph or its opposite.
Points outwardNormals(const SurfaceGraph& graph, const std::vector<float>& agreement) {
  Points normals = alignNeighbors(graph, agreement);
  checkCancelled();
  const TriangleTree tree(graph.corners, graph.triangles);
  RandomStream random(1);
  for (const std::vector<int>& members : membersOfPieces(graph)) {
    if (escapingArea(graph, normals, tree, members, random) < 0.0)
      for (const int element : members) normals.col(element) *= -1.0f;
  }
  return normals;
}

/// Lists the edges of each element.
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

/// The edge is concave if the normals at its ends point toward each other.
float concavityOf(const SurfaceGraph& graph, const SurfaceGraph::Edge& edge) {
  const Eigen::Vector3f a = graph.normals.col(edge.from), b = graph.normals.col(edge.to);
  const float angle = std::atan2(a.cross(b).norm(), a.dot(b));
  const float opening = (a - b).dot(graph.centers.col(edge.to) - graph.centers.col(edge.from));
  return opening > 0.0f ? angle : -angle;
}

/// Completes a graph: index of the edges, outward normals, concavity of the edges.
/// \param graph a graph without first_edge, edge_of and the concavity of the edges; normals of any sign.
/// \param agreement one per edge: > 0 if the normals at both ends point to the same side, < 0 if they do not; a larger
/// magnitude is more certain.
SurfaceGraph completedGraph(SurfaceGraph graph, const std::vector<float>& agreement) {
  indexEdges(graph);
  graph.normals = outwardNormals(graph, agreement);
  const auto max_concavity = static_cast<float>(kPi);
  for (SurfaceGraph::Edge& edge : graph.edges) {
    edge.concavity = concavityOf(graph, edge);
    if (graph.is_cloud)
      edge.concavity = std::clamp(kSegmentation.sharpened * edge.concavity, -max_concavity, max_concavity);
  }
  return graph;
}

/// The surface at a point of a cloud, from the point and its neighbors.
struct LocalSurface {
  Eigen::Vector3f normal, u, v;  ///< unit, perpendicular to each other: least, middle and greatest principal axis
  float area;                    ///< area that the point represents, input units squared
  float border;                  ///< length of the border with each neighbor, input units
};

LocalSurface localSurface(const PointsRef& points, Eigen::Index i, const std::vector<int>& neighbors) {
  Points around(3, neighbors.size() + 1);
  around.col(0) = points.col(i);
  for (std::size_t k = 0; k < neighbors.size(); ++k) around.col(k + 1) = points.col(neighbors[k]);
  const Points offsets = around.colwise() - around.rowwise().mean();
  const Eigen::Matrix3f spread = offsets * offsets.transpose();
  const Eigen::Matrix3f axes = SymmetricEigen<Eigen::Matrix3d>(spread.cast<double>()).eigenvectors().cast<float>();
  LocalSurface local{axes.col(0), axes.col(1), axes.col(2), 0.0f, 0.0f};
  // A disc through the last of k neighbors holds k points: each represents pi r^2 / k.
  const auto count = static_cast<float>(neighbors.size());
  const float radius = (around.rightCols(1) - around.col(0)).norm();
  local.area = static_cast<float>(kPi) * radius * radius / std::max(1.0f, count);
  // Each neighbor takes 1 / k of the perimeter 2 sqrt(pi area) of the disc of that area.
  local.border = 2.0f * std::sqrt(static_cast<float>(kPi) * local.area) / std::max(1.0f, count);
  return local;
}

/// Adds an equilateral triangle in the tangent plane whose incircle has the area of the point.
void addTriangle(SurfaceGraph& graph, Eigen::Index i, const LocalSurface& local) {
  // The circumradius of an equilateral triangle is twice its inradius
  const float circumradius = 2.0f * std::sqrt(local.area / static_cast<float>(kPi));
  for (int k = 0; k < 3; ++k) {
    const float angle = static_cast<float>(2.0 * kPi * k / 3.0);
    graph.corners.col(3 * i + k) =
        graph.centers.col(i) + circumradius * (std::cos(angle) * local.u + std::sin(angle) * local.v);
  }
  const int first = static_cast<int>(3 * i);
  graph.triangles.emplace_back(first, first + 1, first + 2);
  graph.element_of_triangle.push_back(static_cast<int>(i));
}

/// Joins a point with its neighbors; the lower index of two mutual neighbors adds their edge.
void addEdges(SurfaceGraph& graph, int i, const std::vector<std::vector<int>>& neighbors, float length) {
  for (const int j : neighbors[i]) {
    const bool mutual = std::find(neighbors[j].begin(), neighbors[j].end(), i) != neighbors[j].end();
    if (mutual && j < i) continue;
    graph.edges.push_back({i, j, length, 0.0f});
  }
}

void checkNeighbors(const std::vector<std::vector<int>>& neighbors, Eigen::Index num_points) {
  const auto size = static_cast<std::size_t>(num_points);
  check(neighbors.size() == size, "number of lists of neighbors", static_cast<double>(neighbors.size()),
        "that of the points");
  for (const std::vector<int>& list : neighbors)
    for (const int neighbor : list)
      check(neighbor >= 0 && static_cast<std::size_t>(neighbor) < size, "neighbor", neighbor,
            ">= 0 and < the number of points");
}

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
  graph.areas.resize(size);
  for (Eigen::Index f = 0; f < size; ++f) graph.areas[f] = static_cast<float>(areas[f]);
}

/// A face at an edge of the mesh.
struct FaceAtEdge {
  int low, high;  ///< vertices of the edge
  int face;
  bool upwards;  ///< whether the face runs from the lower to the higher vertex

  auto key() const { return std::tie(low, high, face); }
};

/// Joins each face at an edge with the next one.
/// \return the agreement of the two normals: faces of one orientation run through their edge in opposite directions.
std::vector<float> joinFaces(SurfaceGraph& graph, const Polygons& faces) {
  std::vector<FaceAtEdge> at;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % faces[f].size()];
      if (a != b) at.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), a < b});
    }
  }
  checkCancelled();
  std::stable_sort(at.begin(), at.end(), [](const auto& a, const auto& b) { return a.key() < b.key(); });
  checkCancelled();
  at.erase(std::unique(at.begin(), at.end(), [](const auto& a, const auto& b) { return a.key() == b.key(); }),
           at.end());
  std::vector<float> agreement;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const FaceAtEdge &a = at[i - 1], &b = at[i];
    if (a.low != b.low || a.high != b.high) continue;
    graph.edges.push_back({a.face, b.face, (graph.corners.col(a.low) - graph.corners.col(a.high)).norm(), 0.0f});
    agreement.push_back(a.upwards != b.upwards ? 1.0f : -1.0f);
  }
  return agreement;
}

}  // namespace

SurfaceGraph cloudGraph(const PointsRef& points, const std::vector<std::vector<int>>& neighbors) {
  checkNeighbors(neighbors, points.cols());
  checkExtent(points);
  const BoundingBall ball = boundingBall(points);
  check(ball.radius > 0.0, "extent of the points", ball.radius, "> 0");
  const auto size = points.cols();
  SurfaceGraph graph;
  graph.is_cloud = true;
  graph.centers = points;
  graph.normals.resize(3, size);
  graph.areas.resize(size);
  graph.corners.resize(3, 3 * size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const LocalSurface local = localSurface(points, i, neighbors[i]);
    graph.normals.col(i) = local.normal;
    graph.areas[i] = local.area;
    addTriangle(graph, i, local);
    addEdges(graph, static_cast<int>(i), neighbors, local.border);
  }
  check(graph.area() > 0.0, "area of the cloud", graph.area(), "> 0");
  std::vector<float> agreement;
  for (const SurfaceGraph::Edge& edge : graph.edges)
    agreement.push_back(graph.normals.col(edge.from).dot(graph.normals.col(edge.to)));
  return completedGraph(std::move(graph), agreement);
}

SurfaceGraph meshGraph(const PointsRef& vertices, const Polygons& polygons) {
  checkExtent(vertices);
  const Polygons faces = weldedPolygons(vertices, polygons);
  checkCancelled();
  SurfaceGraph graph;
  graph.corners = vertices;
  addTriangles(graph, faces);
  measureFaces(graph, faces);
  check(graph.area() > 0.0, "area of the mesh", graph.area(), "> 0");
  checkCancelled();
  const std::vector<float> agreement = joinFaces(graph, faces);
  return completedGraph(std::move(graph), agreement);
}

double SurfaceGraph::area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
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
      graph.visitNeighbors(element, [&](int neighbor, const SurfaceGraph::Edge&) {
        if (pieces[neighbor] >= 0 || labels[neighbor] != labels[start]) return;
        pieces[neighbor] = num_pieces;
        stack.push_back(neighbor);
      });
    }
    ++num_pieces;
  }
  return pieces;
}

}  // namespace pcl_symmetry
