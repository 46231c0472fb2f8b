#include "core/segmentation/graph_completion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/geometry/triangle_tree.h"
#include "core/segmentation/segmentation_rules.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

namespace {

struct AlignedNormals {
  Points normals;          ///< 3 x N, neighbors of a piece agree
  std::vector<int> piece;  ///< the connected piece of each element
};

/// Turns normals so that neighbors agree, along the most certain edges first (Hoppe et al. 1992).
AlignedNormals alignNeighbors(const SurfaceGraph& graph, const std::vector<float>& agreement) {
  struct Entry {
    float certainty;
    int element;
    float sign;
    bool operator<(const Entry& other) const { return certainty < other.certainty; }
  };
  AlignedNormals aligned{graph.normals, std::vector<int>(static_cast<std::size_t>(graph.size()), -1)};
  std::vector<int>& piece = aligned.piece;
  int num_pieces = 0;
  for (int start = 0; start < graph.size(); ++start) {
    if (piece[start] >= 0) continue;
    std::priority_queue<Entry> queue;
    queue.push({1.0f, start, 1.0f});
    while (!queue.empty()) {
      const Entry next = queue.top();
      queue.pop();
      if (piece[next.element] >= 0) continue;
      piece[next.element] = num_pieces;
      aligned.normals.col(next.element) *= next.sign;
      graph.visitNeighbors(next.element, [&](int neighbor, const SurfaceGraph::Edge& edge) {
        const float agrees = agreement[&edge - graph.edges.data()];
        if (piece[neighbor] < 0) queue.push({std::abs(agrees), neighbor, agrees < 0.0f ? -next.sign : next.sign});
      });
    }
    ++num_pieces;
  }
  return aligned;
}

std::vector<std::vector<int>> membersOf(const std::vector<int>& piece) {
  const int num_pieces = piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end()) + 1;
  std::vector<std::vector<int>> members(static_cast<std::size_t>(num_pieces));
  for (std::size_t i = 0; i < piece.size(); ++i) members[piece[i]].push_back(static_cast<int>(i));
  return members;
}

/// Area of the elements whose rays along the normal leave the shape, minus that of those whose rays against it do.
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
  auto [normals, piece] = alignNeighbors(graph, agreement);
  const TriangleTree tree(graph.corners, graph.triangles);
  RandomStream random(1);
  for (const std::vector<int>& members : membersOf(piece)) {
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

}  // namespace

SurfaceGraph completedGraph(SurfaceGraph graph, const std::vector<float>& agreement) {
  indexEdges(graph);
  graph.normals = outwardNormals(graph, agreement);
  const auto most = static_cast<float>(kPi);
  for (SurfaceGraph::Edge& edge : graph.edges) {
    edge.concavity = concavityOf(graph, edge);
    if (graph.is_cloud) edge.concavity = std::clamp(kSegmentation.sharpened * edge.concavity, -most, most);
  }
  return graph;
}

namespace {

constexpr double least_extent = 1e-15;  // input units; squares and sums stay within float
constexpr double greatest_extent = 1e15;

}  // namespace

void checkExtent(const PointsRef& points) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite()) box.extend(Eigen::Vector3d(points.col(i).cast<double>()));
  const double extent = box.isEmpty() ? 0.0 : box.diagonal().norm();
  check(extent == 0.0 || extent >= least_extent, "extent of the points", extent, ">= 1e-15");
  check(extent <= greatest_extent, "extent of the points", extent, "<= 1e15");
}

}  // namespace pcl_symmetry
