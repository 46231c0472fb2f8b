#include "core/neighbours/triangle_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_symmetry {

namespace {

// triangles; chosen: half and twice as many shift work between boxes and triangles
constexpr int kTrianglesPerLeaf = 4;

/// Intersection of a ray with a triangle (Moeller and Trumbore 1997).
/// \return distance along the ray in lengths of its direction; infinity if it misses the triangle.
float intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, const Eigen::Vector3f& a,
                const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();  // derived: farther than every hit
  const Eigen::Vector3f u = b - a, v = c - a, p = direction.cross(v);
  const float determinant = u.dot(p);
  if (determinant == 0.0f) return kMiss;
  const Eigen::Vector3f t = origin - a;
  const float x = t.dot(p) / determinant;
  if (!(x >= 0.0f && x <= 1.0f)) return kMiss;
  const Eigen::Vector3f q = t.cross(u);
  const float y = direction.dot(q) / determinant;
  if (!(y >= 0.0f && x + y <= 1.0f)) return kMiss;
  return v.dot(q) / determinant;
}

}  // namespace

TriangleTree::TriangleTree(const Points& corners, const std::vector<Eigen::Vector3i>& triangles)
    : corners_(corners), triangles_(triangles), middles_(3, static_cast<Eigen::Index>(triangles.size())) {
  for (std::size_t t = 0; t < triangles.size(); ++t)
    middles_.col(static_cast<Eigen::Index>(t)) =
        (corners.col(triangles[t][0]) + corners.col(triangles[t][1]) + corners.col(triangles[t][2])) / 3.0f;
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(triangles.size() + 1);
  nodes_.emplace_back();
  build(0, 0, static_cast<int>(order_.size()));
}

void TriangleTree::build(int node, int begin, int end) {
  Eigen::AlignedBox3f box, middles;
  for (int i = begin; i < end; ++i) {
    for (int k = 0; k < 3; ++k) box.extend(corners_.col(triangles_[order_[i]][k]));
    middles.extend(middles_.col(order_[i]));
  }
  nodes_[node].min = box.min();
  nodes_[node].max = box.max();
  nodes_[node].first = begin;
  nodes_[node].count = end - begin;
  if (end - begin <= kTrianglesPerLeaf || (middles.sizes().array() <= 0.0f).all()) return;
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    return middles_(axis, a) != middles_(axis, b) ? middles_(axis, a) < middles_(axis, b) : a < b;
  });
  const int children = static_cast<int>(nodes_.size());
  nodes_[node].first = children;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(children, begin, middle);
  build(children + 1, middle, end);
}

RayHit TriangleTree::search(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                            float farthest, bool any) const {
  constexpr int kMaxDepth = 64;  // derived: halving 2^31 triangles gives 31 levels; twice as many
  RayHit hit;
  hit.distance = farthest;
  if (order_.empty()) return hit;
  const Eigen::Array3f inverse = direction.array().inverse(), start = origin.array();
  const auto entry = [&](const Node& node) {
    const Eigen::Array3f a = (node.min - start) * inverse, b = (node.max - start) * inverse;
    const float near = std::max(nearest, a.min(b).maxCoeff()), far = std::min(hit.distance, a.max(b).minCoeff());
    return near <= far ? near : std::numeric_limits<float>::infinity();
  };
  int stack[2 * kMaxDepth];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (std::isinf(entry(node))) continue;
    if (node.count == 0) {
      const bool left_first = entry(nodes_[node.first]) <= entry(nodes_[node.first + 1]);
      stack[depth++] = node.first + (left_first ? 1 : 0);
      stack[depth++] = node.first + (left_first ? 0 : 1);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Eigen::Vector3i& t = triangles_[order_[i]];
      const float distance = intersect(origin, direction, corners_.col(t[0]), corners_.col(t[1]), corners_.col(t[2]));
      if (!(distance > nearest && distance < hit.distance)) continue;
      hit = {order_[i], distance};
      if (any) return hit;
    }
  }
  return hit;
}

RayHit TriangleTree::closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                             float farthest) const {
  return search(origin, direction, nearest, farthest, false);
}

bool TriangleTree::blocks(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  return search(from, to - from, 0.0f, 1.0f, true).triangle >= 0;
}

}  // namespace pcl_symmetry
