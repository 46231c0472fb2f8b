#include "core/geometry/triangle_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_symmetry {

/// Divides the triangles by the medians of their middles.
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
        order(all_triangles.size()) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      middles.col(static_cast<Eigen::Index>(t)) =
          (corners.col(triangles[t][0]) + corners.col(triangles[t][1]) + corners.col(triangles[t][2])) / 3.0f;
    std::iota(order.begin(), order.end(), 0);
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
  Box addChild(int node, int lane, int begin, int end) {
    Box box;
    int child = 0;
    if (end - begin > kWidth) {
      child = static_cast<int>(tree.nodes_.size());
      box = addNode(begin, end);
    } else {
      child = ~static_cast<int>(tree.leaves_.size());
      box = addLeaf(begin, end);
    }
    Node& parent = tree.nodes_[node];
    for (int axis = 0; axis < 3; ++axis) {
      parent.box[0][axis][lane] = box.min[axis];
      parent.box[1][axis][lane] = box.max[axis];
    }
    parent.child[lane] = child;
    return box;
  }

  Box addNode(int begin, int end) {
    const int node = static_cast<int>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    std::vector<int> bounds{begin, end};
    if (end - begin > kWidth) {
      const int middle = halve(begin, end);
      bounds = {begin, halve(begin, middle), middle, halve(middle, end), end};
    }
    const int num_children = static_cast<int>(bounds.size()) - 1;
    tree.nodes_[node].num_children = num_children;
    Box all = addChild(node, 0, bounds[0], bounds[1]);
    for (int lane = 1; lane < num_children; ++lane) {
      const Box box = addChild(node, lane, bounds[lane], bounds[lane + 1]);
      all = {all.min.min(box.min), all.max.max(box.max)};
    }
    return all;
  }

  Box addLeaf(int begin, int end) {
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
    return {box.min(), box.max()};
  }
};

TriangleTree::TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles) {
  if (triangles.empty()) return;
  leaves_.reserve(triangles.size() / 2);
  nodes_.reserve(triangles.size() / 4);
  Builder(*this, corners, triangles).addNode(0, static_cast<int>(triangles.size()));
}

/// Where a ray enters and leaves the boxes of the children. Comparisons with NaN, where a ray runs within a side of a
/// box, leave both as they are.
void TriangleTree::distancesTo(const Node& node, const Ray& ray, float farthest, Lanes& near, Lanes& far) {
  for (int k = 0; k < kWidth; ++k) near[k] = ray.nearest;
  for (int k = 0; k < kWidth; ++k) far[k] = farthest;
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes &enter = node.box[ray.side[axis]][axis], &leave = node.box[1 - ray.side[axis]][axis];
    const float start = ray.origin[axis], inverse = ray.inverse[axis];
    for (int k = 0; k < kWidth; ++k) {
      const float in = (enter[k] - start) * inverse, out = (leave[k] - start) * inverse;
      near[k] = in > near[k] ? in : near[k];
      far[k] = out < far[k] ? out : far[k];
    }
  }
}

/// Intersections of a ray with triangles (Moeller and Trumbore 1997), in lengths of its direction; infinity where it
/// misses the triangle.
void TriangleTree::distancesTo(const Leaf& leaf, const Ray& ray, Lanes& distances) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();  // farther than every hit
  const float d0 = ray.direction[0], d1 = ray.direction[1], d2 = ray.direction[2];
  for (int k = 0; k < kWidth; ++k) {
    const float u0 = leaf.u[0][k], u1 = leaf.u[1][k], u2 = leaf.u[2][k];
    const float v0 = leaf.v[0][k], v1 = leaf.v[1][k], v2 = leaf.v[2][k];
    const float p0 = d1 * v2 - d2 * v1, p1 = d2 * v0 - d0 * v2, p2 = d0 * v1 - d1 * v0;
    const float determinant = u0 * p0 + (u1 * p1 + u2 * p2);
    const float t0 = ray.origin[0] - leaf.a[0][k], t1 = ray.origin[1] - leaf.a[1][k], t2 = ray.origin[2] - leaf.a[2][k];
    const float x = (t0 * p0 + (t1 * p1 + t2 * p2)) / determinant;
    const float q0 = t1 * u2 - t2 * u1, q1 = t2 * u0 - t0 * u2, q2 = t0 * u1 - t1 * u0;
    const float y = (d0 * q0 + (d1 * q1 + d2 * q2)) / determinant;
    const float distance = (v0 * q0 + (v1 * q1 + v2 * q2)) / determinant;
    const bool inside = (determinant != 0.0f) & (x >= 0.0f) & (x <= 1.0f) & (y >= 0.0f) & (x + y <= 1.0f);
    distances[k] = inside ? distance : kMiss;
  }
}

RayHit TriangleTree::search(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                            float farthest, bool any) const {
  RayHit hit;
  hit.distance = farthest;
  if (nodes_.empty()) return hit;
  Ray ray;
  ray.nearest = nearest;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.direction[axis] = direction[axis];
    ray.inverse[axis] = 1.0f / direction[axis];
    ray.side[axis] = ray.inverse[axis] < 0.0f ? 1 : 0;
  }
  struct Open {
    float near;
    int child;
  };
  Open stack[kMostOpen];
  int depth = 0;
  stack[depth++] = {nearest, 0};
  while (depth > 0) {
    const Open next = stack[--depth];
    if (!(next.near <= hit.distance)) continue;
    if (next.child < 0) {
      const Leaf& leaf = leaves_[~next.child];
      Lanes distances;
      distancesTo(leaf, ray, distances);
      for (int k = 0; k < kWidth; ++k)
        if (distances[k] > nearest && distances[k] < hit.distance) hit = {leaf.triangle[k], distances[k]};
      if (any && hit.triangle >= 0) return hit;
      continue;
    }
    const Node& node = nodes_[next.child];
    Lanes near, far;
    distancesTo(node, ray, hit.distance, near, far);
    const int behind = depth;
    for (int k = 0; k < node.num_children; ++k) {
      if (!(near[k] <= far[k])) continue;
      int position = depth++;
      for (; !any && position > behind && stack[position - 1].near < near[k]; --position)
        stack[position] = stack[position - 1];
      stack[position] = {near[k], node.child[k]};
    }
  }
  return hit;
}

RayHit TriangleTree::closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                             float farthest) const {
  return search(origin, direction, nearest, farthest, false);
}

namespace {

/// The point a + s u + t v of a triangle that is closest to a + w (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3f closestOffset(const Eigen::Vector3f& u, const Eigen::Vector3f& v, const Eigen::Vector3f& w) {
  const float d1 = u.dot(w), d2 = v.dot(w);
  if (d1 <= 0.0f && d2 <= 0.0f) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f to_u = w - u, to_v = w - v;
  const float d3 = u.dot(to_u), d4 = v.dot(to_u);
  if (d3 >= 0.0f && d4 <= d3) return u;
  const float d5 = u.dot(to_v), d6 = v.dot(to_v);
  if (d6 >= 0.0f && d5 <= d6) return v;
  const float c = d1 * d4 - d3 * d2;
  if (c <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return d1 / (d1 - d3) * u;
  const float b = d5 * d2 - d1 * d6;
  if (b <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return d2 / (d2 - d6) * v;
  const float a = d3 * d6 - d5 * d4;
  if (a <= 0.0f && d4 >= d3 && d5 >= d6) return u + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (v - u);
  const Eigen::Vector3f normal = u.cross(v);  // a slender triangle has weights of its corners that are rounding
  return w - normal.dot(w) / normal.squaredNorm() * normal;
}

}  // namespace

ClosestOnTriangles TriangleTree::closestTo(const Eigen::Vector3f& x) const {
  ClosestOnTriangles found;
  if (nodes_.empty()) return found;
  struct Open {
    float sq_distance;
    int child;
  };
  Open stack[kMostOpen];
  int depth = 0;
  stack[depth++] = {0.0f, 0};
  while (depth > 0) {
    const Open next = stack[--depth];
    if (!(next.sq_distance < found.sq_distance)) continue;
    if (next.child < 0) {
      const Leaf& leaf = leaves_[~next.child];
      for (int k = 0; k < leaf.size; ++k) {
        const Eigen::Vector3f a(leaf.a[0][k], leaf.a[1][k], leaf.a[2][k]), u(leaf.u[0][k], leaf.u[1][k], leaf.u[2][k]),
            v(leaf.v[0][k], leaf.v[1][k], leaf.v[2][k]);
        const Eigen::Vector3f point = a + closestOffset(u, v, x - a);
        const float sq_distance = (x - point).squaredNorm();
        if (sq_distance < found.sq_distance) found = {leaf.triangle[k], point, sq_distance};
      }
      continue;
    }
    const Node& node = nodes_[next.child];
    Lanes sq_distances{};
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < kWidth; ++k) {
        const float below = node.box[0][axis][k] - x[axis], above = x[axis] - node.box[1][axis][k];
        const float out = std::max(0.0f, std::max(below, above));
        sq_distances[k] += out * out;
      }
    const int behind = depth;
    for (int k = 0; k < node.num_children; ++k) {
      int position = depth++;
      for (; position > behind && stack[position - 1].sq_distance < sq_distances[k]; --position)
        stack[position] = stack[position - 1];
      stack[position] = {sq_distances[k], node.child[k]};
    }
  }
  return found;
}

bool TriangleTree::blocks(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  return search(from, to - from, 0.0f, 1.0f, true).triangle >= 0;
}

}  // namespace pcl_symmetry
