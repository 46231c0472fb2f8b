#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/segmentation/graph_completion.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

namespace {

/// The surface at a point of a cloud, from the point and its neighbors.
struct LocalSurface {
  Eigen::Vector3f normal, u, v;  ///< unit, perpendicular to each other: least, middle and greatest principal axis
  float area;                    ///< that the point represents, input units squared
  float border;                  ///< with each neighbor, input units
};

LocalSurface localSurface(const PointsRef& points, Eigen::Index i, const std::vector<int>& neighbors) {
  Points around(3, static_cast<Eigen::Index>(neighbors.size()) + 1);
  around.col(0) = points.col(i);
  for (std::size_t k = 0; k < neighbors.size(); ++k)
    around.col(static_cast<Eigen::Index>(k) + 1) = points.col(neighbors[k]);
  const Points offsets = around.colwise() - around.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(offsets * offsets.transpose());
  LocalSurface local{axes.eigenvectors().col(0), axes.eigenvectors().col(1), axes.eigenvectors().col(2), 0.0f, 0.0f};
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

}  // namespace

std::vector<std::vector<int>> nearestOthers(const PointsRef& points, const ClosestPointSearch& search,
                                            int num_neighbors, int num_threads) {
  const auto size = static_cast<std::size_t>(points.cols());
  const std::size_t num_others = std::min<std::size_t>(num_neighbors, size - 1), num_found = num_others + 1;
  std::vector<std::vector<int>> neighbors(size);
  parallelRanges(size, 1024, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> found;
    std::vector<float> sq_distances;
    search.search(points.middleCols(begin, end - begin), static_cast<int>(num_found), found, sq_distances);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = (i - begin) * num_found; k < (i - begin + 1) * num_found; ++k)
        if (found[k] != static_cast<int>(i) && neighbors[i].size() < num_others) neighbors[i].push_back(found[k]);
  });
  return neighbors;
}

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
  graph.areas.resize(static_cast<std::size_t>(size));
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

}  // namespace pcl_symmetry
