#include "core/geometry/triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

/// Divides the triangles at the medians of their middles.
struct TriangleTree::Builder {
  TriangleTree& tree;
  const Points& corners;
  const std::vector<Eigen::Vector3i>& triangles;
  Points middles;
  std::vector<int> order;

  Builder(TriangleTree& tree_to_build, const Points& all_corners, const std::vector<Eigen::Vector3i>& all_triangles)
      : tree(tree_to_build),
        corners(all_corners),
        triangles(all_triangles),
        middles(3, static_cast<Eigen::Index>(all_triangles.size())),
        order(allIndices(static_cast<Eigen::Index>(all_triangles.size()))) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      middles.col(t) =
          (corners.col(triangles[t][0]) + corners.col(triangles[t][1]) + corners.col(triangles[t][2])) / 3.0f;
  }

  /// Moves the half with the lower middles, along the axis of their greatest extent, to the front.
  /// \return where the other half begins.
  int halve(int begin, int end) {
    Eigen::AlignedBox3f extent;
    for (int i = begin; i < end; ++i) extent.extend(middles.col(order[i]));
    Eigen::Index axis = 0;
    extent.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
      return middles(axis, a) != middles(axis, b) ? middles(axis, a) < middles(axis, b) : a < b;
    });
    return middle;
  }

  /// \return the bounds of the child in a lane of a node.
  Eigen::AlignedBox3f addChild(int node, int lane, int begin, int end) {
    const bool is_leaf = end - begin <= kWidth;
    const int child = static_cast<int>(is_leaf ? ~tree.leaves_.size() : tree.nodes_.size());
    const Eigen::AlignedBox3f box = is_leaf ? addLeaf(begin, end) : addNode(begin, end);
    Node& parent = tree.nodes_[node];
    for (int axis = 0; axis < 3; ++axis) {
      parent.box[0][axis][lane] = box.min()[axis];
      parent.box[1][axis][lane] = box.max()[axis];
    }
    parent.child[lane] = child;
    return box;
  }

  Eigen::AlignedBox3f addNode(int begin, int end) {
    if (end - begin > 1000) checkCancelled();
    const int node = static_cast<int>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    std::vector<int> bounds{begin, end};
    if (end - begin > kWidth) {
      const int middle = halve(begin, end);
      bounds = {begin, halve(begin, middle), middle, halve(middle, end), end};
    }
    const int num_children = static_cast<int>(bounds.size()) - 1;
    tree.nodes_[node].num_children = num_children;
    Eigen::AlignedBox3f all;
    for (int lane = 0; lane < num_children; ++lane) all.extend(addChild(node, lane, bounds[lane], bounds[lane + 1]));
    return all;
  }

  Eigen::AlignedBox3f addLeaf(int begin, int end) {
    Leaf leaf{};
    Eigen::AlignedBox3f box;
    for (int i = begin; i < end; ++i) {
      const int lane = i - begin;
      const Eigen::Vector3i& t = triangles[order[i]];
      const Eigen::Vector3f a = corners.col(t[0]), u = corners.col(t[1]) - a, v = corners.col(t[2]) - a;
      for (int axis = 0; axis < 3; ++axis) {
        leaf.a[axis][lane] = a[axis];
        leaf.u[axis][lane] = u[axis];
        leaf.v[axis][lane] = v[axis];
      }
      leaf.triangle[lane] = order[i];
      leaf.size = lane + 1;
      for (int k = 0; k < 3; ++k) box.extend(corners.col(t[k]));
    }
    tree.leaves_.push_back(leaf);
    return box;
  }
};

TriangleTree::TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles) {
  if (triangles.empty()) return;
  leaves_.reserve(triangles.size() / 2);
  nodes_.reserve(triangles.size() / 4);
  Builder(*this, corners, triangles).addNode(0, static_cast<int>(triangles.size()));
}

namespace {

/// Stack of the nodes that a search has yet to open.
struct OpenBoxes {
  static constexpr int kMost = 64;  // 2^31 triangles have 16 levels; each leaves at most three children behind
  struct Box {
    int child;
    float distance;
  } boxes[kMost];
  int size = 0;

  /// \param behind number of boxes that are opened after this one, near or not.
  void add(int child, float distance, int behind) {
    int position = size++;
    for (; position > behind && boxes[position - 1].distance < distance; --position)
      boxes[position] = boxes[position - 1];
    boxes[position] = {child, distance};
  }
};

}  // namespace

/// Where a ray enters and leaves the boxes of the children. Comparisons with NaN, if a ray runs within a side of a box,
/// leave both values unchanged.
void TriangleTree::distancesTo(const Node& node, const Ray& ray, float farthest, Lanes& near, Lanes& far) {
  near = Lanes{} + ray.nearest;
  far = Lanes{} + farthest;
  for (int axis = 0; axis < 3; ++axis) {
    const int side = ray.side[axis];
    const Lanes in = (node.box[side][axis] - ray.origin[axis]) * ray.inverse[axis],
                out = (node.box[1 - side][axis] - ray.origin[axis]) * ray.inverse[axis];
    near = in > near ? in : near;
    far = out < far ? out : far;
  }
}

/// Intersections of a ray with triangles (Moeller and Trumbore 1997), in lengths of its direction; infinity if it
/// misses the triangle.
TriangleTree::Lanes TriangleTree::distancesTo(const Leaf& leaf, const Ray& ray) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();  // farther than every hit
  const Vectors direction = same(ray.direction.data()), from_a = minus(same(ray.origin.data()), leaf.a);
  const Vectors p = cross(direction, leaf.v), q = cross(from_a, leaf.u);
  const Lanes determinant = dot(leaf.u, p);
  const Lanes x = dot(from_a, p) / determinant, y = dot(direction, q) / determinant;
  const auto inside = (determinant != 0.0f) & (x >= 0.0f) & (x <= 1.0f) & (y >= 0.0f) & (x + y <= 1.0f);
  return inside ? dot(leaf.v, q) / determinant : Lanes{} + kMiss;
}

RayHit TriangleTree::search(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                            float farthest, bool any) const {
  RayHit hit;
  hit.distance = farthest;
  if (nodes_.empty()) return hit;
  Ray ray{origin, direction, direction.cwiseInverse(), {}, nearest};
  for (int axis = 0; axis < 3; ++axis) ray.side[axis] = ray.inverse[axis] < 0.0f ? 1 : 0;
  OpenBoxes open;
  open.add(0, nearest, 0);
  while (open.size > 0) {
    const OpenBoxes::Box next = open.boxes[--open.size];
    if (!(next.distance <= hit.distance)) continue;
    if (next.child < 0) {
      const Leaf& leaf = leaves_[~next.child];
      const Lanes distances = distancesTo(leaf, ray);
      for (int k = 0; k < kWidth; ++k)
        if (distances[k] > nearest && distances[k] < hit.distance) hit = {leaf.triangle[k], distances[k]};
      if (any && hit.triangle >= 0) return hit;
      continue;
    }
    const Node& node = nodes_[next.child];
    Lanes near, far;
    distancesTo(node, ray, hit.distance, near, far);
    const int behind = open.size;
    for (int k = 0; k < node.num_children; ++k)
      if (near[k] <= far[k]) open.add(node.child[k], near[k], any ? open.size : behind);
  }
  return hit;
}

/// The points a + start + share * direction of triangles that are closest to a point (Ericson, Real-Time Collision
/// Detection, 5.1.5).
TriangleTree::Vectors TriangleTree::closestPoints(const Leaf& leaf, const Vectors& x) {
  const Vectors &u = leaf.u, &v = leaf.v, w = minus(x, leaf.a), from_u = minus(w, u), from_v = minus(w, v);
  const Lanes d1 = dot(u, w), d2 = dot(v, w), d3 = dot(u, from_u), d4 = dot(v, from_u), d5 = dot(u, from_v),
              d6 = dot(v, from_v);
  const Lanes a = d3 * d6 - d5 * d4, b = d5 * d2 - d1 * d6, c = d1 * d4 - d3 * d2, to_v = d4 - d3, to_u = d5 - d6;
  // First, the closest point within the triangle. In a slender triangle, the weights of the corners are rounding
  // errors.
  Vectors start = w, direction = cross(u, v);
  Lanes share = -dot(direction, w) / dot(direction, direction);
  const auto takeIf = [&](const auto& here, const Vectors& from, const Lanes& by, const Vectors& along) {
    share = here ? by : share;
    for (int axis = 0; axis < 3; ++axis) {
      start[axis] = here ? from[axis] : start[axis];
      direction[axis] = here ? along[axis] : direction[axis];
    }
  };
  const Vectors zero{};
  takeIf((a <= 0.0f) & (to_v >= 0.0f) & (to_u >= 0.0f), u, to_v / (to_v + to_u), minus(v, u));
  takeIf((b <= 0.0f) & (d2 >= 0.0f) & (d6 <= 0.0f), zero, d2 / (d2 - d6), v);
  takeIf((c <= 0.0f) & (d1 >= 0.0f) & (d3 <= 0.0f), zero, d1 / (d1 - d3), u);
  takeIf((d6 >= 0.0f) & (d5 <= d6), v, Lanes{}, zero);
  takeIf((d3 >= 0.0f) & (d4 <= d3), u, Lanes{}, zero);
  takeIf((d1 <= 0.0f) & (d2 <= 0.0f), zero, Lanes{}, zero);
  for (int axis = 0; axis < 3; ++axis) start[axis] = leaf.a[axis] + (start[axis] + share * direction[axis]);
  return start;
}

ClosestOnTriangles TriangleTree::closestTo(const Eigen::Vector3f& x, float sq_reach) const {
  ClosestOnTriangles found;
  found.sq_distance = sq_reach;
  if (nodes_.empty()) return found;
  const Vectors all_x = same(x.data());
  OpenBoxes open;
  open.add(0, 0.0f, 0);
  while (open.size > 0) {
    const OpenBoxes::Box next = open.boxes[--open.size];
    if (!(next.distance < found.sq_distance)) continue;
    if (next.child < 0) {
      const Leaf& leaf = leaves_[~next.child];
      const Vectors points = closestPoints(leaf, all_x), off = minus(all_x, points);
      const Lanes sq_distances = dot(off, off);
      for (int k = 0; k < leaf.size; ++k)
        if (sq_distances[k] < found.sq_distance)
          found = {leaf.triangle[k], {points[0][k], points[1][k], points[2][k]}, sq_distances[k]};
      continue;
    }
    const Node& node = nodes_[next.child];
    Lanes sq_distances{};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = node.box[0][axis] - x[axis], above = x[axis] - node.box[1][axis];
      const Lanes beyond = below > above ? below : above, out = beyond > 0.0f ? beyond : Lanes{};
      sq_distances += out * out;
    }
    const int behind = open.size;
    for (int k = 0; k < node.num_children; ++k)
      if (sq_distances[k] < found.sq_distance) open.add(node.child[k], sq_distances[k], behind);
  }
  return found;
}

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
