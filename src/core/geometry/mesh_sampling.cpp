#include "core/geometry/mesh_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/random.h"
#include "core/geometry/distinct_points.h"

namespace pcl_symmetry {

std::vector<Eigen::Vector3i> finiteTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3i> finite;
  for (const Eigen::Vector3i& triangle : triangles) {
    for (const int i : triangle) check(i >= 0 && i < vertices.cols(), "triangle vertex", i, "an index of a vertex");
    if (vertices(Eigen::all, triangle).allFinite()) finite.push_back(triangle);
  }
  return finite;
}

Points sampleTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles, int num_points,
                       std::uint64_t seed) {
  check(num_points >= 1, "num_points", num_points, ">= 1");
  std::vector<double> area_up_to;
  std::vector<Eigen::Vector3i> used;
  double area = 0.0;
  const auto vertex = [&](int i) -> Eigen::Vector3d { return vertices.col(i).cast<double>(); };
  for (const Eigen::Vector3i& triangle : finiteTriangles(vertices, triangles)) {
    const Eigen::Vector3d a = vertex(triangle[0]);
    const double share = 0.5 * (vertex(triangle[1]) - a).cross(vertex(triangle[2]) - a).norm();
    if (!std::isfinite(share) || share == 0.0) continue;
    area += share;
    used.push_back(triangle);
    area_up_to.push_back(area);
  }
  check(area > 0.0, "total area of the triangles", area, "> 0");

  Points points(3, num_points);
  RandomStream random(seed);
  std::size_t t = 0;
  for (int i = 0; i < num_points; ++i) {
    const double target = (i + random.uniform()) * area / num_points;
    while (t + 1 < used.size() && area_up_to[t] <= target) ++t;
    const double root = std::sqrt(random.uniform()), along = random.uniform();
    const Eigen::Vector3d point = (1.0 - root) * vertex(used[t][0]) + root * (1.0 - along) * vertex(used[t][1]) +
                                  root * along * vertex(used[t][2]);
    points.col(i) = point.cast<float>();
  }
  return points;
}

std::vector<std::pair<int, int>> openEdges(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles) {
  const std::vector<int> same = firstCopies(vertices);
  std::vector<std::pair<int, int>> edges, open;
  for (const Eigen::Vector3i& triangle : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = same[triangle[k]], b = same[triangle[(k + 1) % 3]];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end == i + 1) open.push_back(edges[i]);
    i = end;
  }
  return open;
}

}  // namespace pcl_symmetry
