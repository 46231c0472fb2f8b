#include "core/frame/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_symmetry {

namespace {

// Longer sides of the box, depth within which the outline touches a side. chosen: half misses feet of scanned points,
// twice takes round bottoms for flat ones.
constexpr float kTouch = 0.01f;

/// Twice the area of a triangle, positive where it turns to the left.
float turn(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Andrew's monotone chain (1979).
std::vector<Eigen::Vector2f> convexHull(std::vector<Eigen::Vector2f> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2f> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2f& point : points) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0f) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

struct Extent {
  float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();

  void add(float value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  float length() const { return std::max(high - low, 0.0f); }
};

}  // namespace

Outline::Outline(const PointsRef& points, const Eigen::Vector3f& along)
    : u_(along.unitOrthogonal()), v_(along.cross(u_)) {
  std::vector<Eigen::Vector2f> seen;
  seen.reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) seen.emplace_back(u_.dot(points.col(i)), v_.dot(points.col(i)));
  corners_ = convexHull(std::move(seen));
}

Eigen::Vector3f Outline::direction(double angle) const {
  return static_cast<float>(std::cos(angle)) * u_ + static_cast<float>(std::sin(angle)) * v_;
}

double Outline::angleOf(const Eigen::Vector3f& vector) const {
  return std::atan2(v_.dot(vector), u_.dot(vector));
}

Outline::Box Outline::boxAt(double angle) const {
  const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  const std::array<Eigen::Vector2f, 2> sides{Eigen::Vector2f(c, s), Eigen::Vector2f(-s, c)};
  std::array<Extent, 2> extents;
  for (const Eigen::Vector2f& corner : corners_)
    for (std::size_t k = 0; k < 2; ++k) extents[k].add(sides[k].dot(corner));
  const float longer = std::max(extents[0].length(), extents[1].length());
  Box box;
  box.area = static_cast<double>(extents[0].length()) * extents[1].length();
  if (!(longer > 0.0f)) return box;
  for (std::size_t k = 0; k < 2; ++k) {
    Extent low, high;  // along the other side
    for (const Eigen::Vector2f& corner : corners_) {
      const float depth = sides[k].dot(corner), along = sides[1 - k].dot(corner);
      if (depth <= extents[k].low + kTouch * longer) low.add(along);
      if (depth >= extents[k].high - kTouch * longer) high.add(along);
    }
    box.contact = std::max<double>(box.contact, std::max(low.length(), high.length()) / longer);
  }
  return box;
}

}  // namespace pcl_symmetry
