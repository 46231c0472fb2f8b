#include "core/segmentation/graph_completion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/constants.h"
#include "core/segmentation/orientation.h"
#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

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

/// The edge is concave if the normals at its ends point towards each other.
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

}  // namespace pcl_symmetry
