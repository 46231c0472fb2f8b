#include "pcl_symmetry/core/symmetrized_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/geometry/triangles.h"

namespace pcl_symmetry {

namespace {

struct SymmetrizingRules {
  // Iterations; the mean of closest points slides along slopes by their square, so the third is below 1e-6.
  int passes = 3;
  float paired = 0.5f;      // distance of a counterpart, at most, in distances of the second closest vertex
  float gap = 0.02f;        // distance beside a border, radii, beyond which the other side has a hole
  float at_border = 1e-5f;  // distance from a border, radii, within which a point lies at it
  int judged = 5000;        // vertices at which the deviation is measured
  float beside = 2.0f;      // distance beside a sample of a cloud, spacings, beyond which there is no surface
  // Greatest distance of vertices on the plane, as a share of the greatest distance from the plane.
  double on_plane = 1e-6;
  double pair_share = 0.01;  // greatest distance of a counterpart by default, as a share of the diameter
};
constexpr SymmetrizingRules kSymmetrizing;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Reflects a point in the plane through 0 with this normal.
Eigen::Vector3f reflected(const Eigen::Vector3f& x, const Eigen::Vector3f& normal) {
  return x - 2.0f * normal.dot(x) * normal;
}

Eigen::Vector3f movedTo(const Eigen::Vector3f& x, const Eigen::Vector3f& other, const Eigen::Vector3f& normal,
                        SymmetrizedHalf half) {
  if (half == SymmetrizedHalf::Mean) return 0.5f * (x + other);
  return (normal.dot(x) < 0.0f) == (half == SymmetrizedHalf::Left) ? x : other;
}

/// Normals of the vertices, whose lengths are a third of the area of their triangles.
Points vertexNormals(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles) {
  Points normals = Points::Zero(3, vertices.cols());
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3f a = vertices.col(t[0]);
    const Eigen::Vector3f normal = (vertices.col(t[1]) - a).cross(vertices.col(t[2]) - a) / 6.0f;
    for (int k = 0; k < 3; ++k) normals.col(t[k]) += normal;
  }
  return normals;
}

/// The surface of a mesh at the reflections of its vertices.
struct OtherSide {
  Points points;              // closest points
  std::vector<int> vertices;  // counterparts; -1 if none is close
};

OtherSide otherSide(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles,
                    const Eigen::Vector3f& normal, const std::vector<char>& used, int num_threads) {
  const TriangleTree tree(vertices, triangles);
  OtherSide found{Points(3, vertices.cols()), std::vector<int>(used.size(), -1)};
  parallelPoints(used.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!used[i]) continue;
      const Eigen::Vector3f x = reflected(vertices.col(i), normal);
      const ClosestOnTriangles closest = tree.closestTo(x);
      found.points.col(i) = closest.point;
      float least = std::numeric_limits<float>::infinity(), second = least;
      for (const int corner : triangles[closest.triangle]) {
        const float distance = (vertices.col(corner) - x).norm();
        if (distance < least) {
          second = least;
          least = distance;
          found.vertices[i] = corner;
        } else {
          second = std::min(second, distance);
        }
      }
      if (!(least < kSymmetrizing.paired * second)) found.vertices[i] = -1;
    }
  });
  return found;
}

/// Which of the vertices used can move: all except those whose reflection lies beside a border, where the other side
/// has no surface.
std::vector<char> movingVertices(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles,
                                 const Points& normals, const Eigen::Vector3f& normal, const OtherSide& other,
                                 const std::vector<char>& used) {
  std::vector<char> moves = used;
  std::vector<Eigen::Vector3i> segments;
  for (const auto& [a, b] : openEdges(vertices, triangles)) segments.emplace_back(a, b, b);
  if (segments.empty()) return moves;
  const TriangleTree borders(vertices, segments);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Eigen::Vector3f apart = reflected(vertices.col(i), normal) - other.points.col(i);
    const Eigen::Vector3f across = reflected(normals.col(i).stableNormalized(), normal);
    if (!((apart - across.dot(apart) * across).norm() > kSymmetrizing.gap)) continue;
    const float reach = kSymmetrizing.at_border;
    moves[i] = !(borders.closestTo(other.points.col(i)).sq_distance < reach * reach);
  }
  return moves;
}

/// Mean and greatest absolute value of the asymmetry.
void summarize(SymmetrizedShape& shape, const std::vector<double>& weights) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < shape.asymmetry.size(); ++i) {
    const double value = std::abs(static_cast<double>(shape.asymmetry[i]));
    if (!std::isfinite(value)) continue;
    sum += weights[i] * value;
    weight += weights[i];
    shape.greatest_asymmetry = std::max(shape.greatest_asymmetry, value);
  }
  shape.mean_asymmetry = weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace

SymmetrizedShape symmetrizedMesh(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                                 const ReflectionPlane& plane, SymmetrizedHalf half, int num_threads) {
  const std::vector<Eigen::Vector3i> finite = finiteTriangles(vertices, triangles);
  std::vector<char> used(vertices.cols(), 0);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& triangle : finite)
    for (const int i : triangle) {
      used[i] = 1;
      box.extend(vertices.col(i).cast<double>());
    }
  const double radius = box.isEmpty() ? 0.0 : 0.5 * box.diagonal().norm();
  check(radius > 0.0, "extent of the mesh", radius, "> 0");
  const Eigen::Vector3d middle = box.center();
  const Eigen::Vector3d origin = middle - plane.signedDistance(middle) * plane.normal();
  const Eigen::Vector3f normal = plane.normal().cast<float>();

  Points moved = normalizePoints(vertices, origin, radius);
  const Points normals = vertexNormals(moved, finite);
  SymmetrizedShape result;
  result.points = vertices;
  result.asymmetry.assign(used.size(), kNone);
  OtherSide other = otherSide(moved, finite, normal, used, num_threads);
  const std::vector<char> moves = movingVertices(moved, finite, normals, normal, other, used);
  std::vector<double> areas(used.size(), 0.0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!moves[i]) continue;
    areas[i] = normals.col(i).norm();
    const Eigen::Vector3f apart = moved.col(i) - reflected(other.points.col(i), normal);
    result.asymmetry[i] = static_cast<float>(radius) * normals.col(i).stableNormalized().dot(apart);
  }
  summarize(result, areas);

  for (int pass = 0; pass < kSymmetrizing.passes; ++pass) {
    if (pass > 0) other = otherSide(moved, finite, normal, used, num_threads);
    const Points before = moved;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!moves[i]) continue;
      const int j = other.vertices[i];
      const bool is_pair = j >= 0 && other.vertices[j] == static_cast<int>(i);
      Eigen::Vector3f counterpart = other.points.col(i);
      if (is_pair) counterpart = before.col(j);
      moved.col(i) = movedTo(before.col(i), reflected(counterpart, normal), normal, half);
    }
  }

  std::vector<char> judged(used.size(), 0);
  const std::size_t stride = std::max<std::size_t>(1, used.size() / kSymmetrizing.judged);
  for (std::size_t i = 0; i < used.size(); i += stride) judged[i] = moves[i];
  other = otherSide(moved, finite, normal, judged, num_threads);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (judged[i])
      result.deviation =
          std::max(result.deviation, radius * (reflected(moved.col(i), normal) - other.points.col(i)).norm());
    if (moves[i]) result.points.col(i) = (origin + radius * moved.col(i).cast<double>()).cast<float>();
  }
  return result;
}

MirroredMesh mirroredHalf(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                          const ReflectionPlane& plane, bool left) {
  const std::vector<Eigen::Vector3i> finite = finiteTriangles(vertices, triangles);
  std::vector<double> heights(vertices.cols());  // positive on the side that is kept
  double greatest = 0.0;
  for (const Eigen::Vector3i& t : finite)
    for (const int i : t) {
      heights[i] = (left ? -1.0 : 1.0) * plane.signedDistance(vertices.col(i).cast<double>());
      greatest = std::max(greatest, std::abs(heights[i]));
    }
  for (double& height : heights)
    if (std::abs(height) < kSymmetrizing.on_plane * greatest) height = 0.0;

  MirroredMesh result;
  std::vector<Eigen::Vector3d> points;
  std::vector<int> reflections;
  std::map<std::pair<int, int>, int> known;  // vertices that stay, by (a, a), and cuts of an edge, by (a, b)
  const auto vertex = [&](int a, int b) {
    if (a > b) std::swap(a, b);
    const auto [entry, is_new] = known.try_emplace({a, b}, static_cast<int>(points.size()));
    if (!is_new) return entry->second;
    const double share = a == b ? 0.0 : heights[a] / (heights[a] - heights[b]);
    const Eigen::Vector3d x = (1.0 - share) * vertices.col(a).cast<double>() + share * vertices.col(b).cast<double>();
    const bool is_shared = a != b || heights[a] == 0.0;
    points.push_back(is_shared ? Eigen::Vector3d(0.5 * (x + plane.reflect(x))) : x);
    if (!is_shared) points.push_back(plane.reflect(x));
    reflections.push_back(static_cast<int>(points.size()) - 1);
    reflections.resize(points.size(), entry->second);
    result.sources.resize(points.size(), share > 0.5 ? b : a);
    return entry->second;
  };
  std::size_t num_done = 0;
  for (const Eigen::Vector3i& t : finite) {
    if (++num_done % 1024 == 0) checkCancelled();
    if (std::max({heights[t[0]], heights[t[1]], heights[t[2]]}) <= 0.0) continue;
    std::vector<int> corners;  // corners of the part that is kept
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (heights[a] >= 0.0) corners.push_back(vertex(a, a));
      if (heights[a] * heights[b] < 0.0) corners.push_back(vertex(a, b));
    }
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const int a = corners[0], b = corners[k - 1], c = corners[k];
      result.triangles.emplace_back(a, b, c);
      result.triangles.emplace_back(reflections[a], reflections[c], reflections[b]);
    }
  }
  result.vertices.resize(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.vertices.col(i) = points[i].cast<float>();
  return result;
}

SymmetrizedShape symmetrizedCloud(const PointsRef& points, const ReflectionPlane& plane, SymmetrizedHalf half,
                                  int num_threads) {
  check(points.cols() > 0, "number of points", points.cols(), "> 0");
  SymmetrizedShape result;
  result.points = points;
  result.asymmetry.assign(points.cols(), kNone);
  const auto search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(result.points, *search, num_threads);
  const Eigen::Vector3d center = centerOfMass(points);
  const Points images = reflectedPoints(points, plane);
  const std::vector<int> closest = closestPoints(*search, images, num_threads).index;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>(), image = images.col(i).cast<double>();
    const bool is_left = plane.signedDistance(x) < 0.0;
    if (half == SymmetrizedHalf::Mean || is_left == (half == SymmetrizedHalf::Left))
      result.kept.push_back(static_cast<int>(i));
    const Eigen::Vector3d across = geometry.normals.col(closest[i]).cast<double>();
    const Eigen::Vector3d apart = image - points.col(closest[i]).cast<double>();
    const double height = across.dot(apart);
    if (std::sqrt(std::max(0.0, apart.squaredNorm() - height * height)) >
        kSymmetrizing.beside * geometry.spacing[closest[i]])
      continue;
    const Eigen::Vector3d other = plane.reflect(image - height * across);
    const Eigen::Vector3d normal = geometry.normals.col(i).cast<double>();
    const double outward = normal.dot(x - center) < 0.0 ? -1.0 : 1.0;
    result.asymmetry[i] = static_cast<float>(outward * normal.dot(x - other));
    if (half == SymmetrizedHalf::Mean) result.points.col(i) = (0.5 * (x + other)).cast<float>();
  }
  summarize(result, std::vector<double>(result.asymmetry.size(), 1.0));
  return result;
}

ReflectedPairs reflectedPairs(const PointsRef& points, const ReflectionPlane& plane, double max_distance) {
  check(max_distance >= 0.0, "max_distance", max_distance, ">= 0");
  if (points.cols() == 0) return {};
  if (max_distance == 0.0) max_distance = kSymmetrizing.pair_share * approximateDiameter(withoutStrayPoints(points));
  auto [index, sq_distances] = closestPoints(*makeFlannSearch(points), reflectedPoints(points, plane), 0);
  for (std::size_t i = 0; i < index.size(); ++i)
    if (sq_distances[i] > max_distance * max_distance) index[i] = -1;
  return {std::move(index), std::move(sq_distances)};
}

LandmarkAsymmetry landmarkAsymmetry(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs,
                                    const std::vector<Eigen::Vector3d>& midline, const ReflectionPlane& plane) {
  LandmarkAsymmetry result;
  double paired = 0.0, object = 0.0;
  for (const auto& [first, second] : pairs) {
    result.paired.emplace_back(plane.reflect(first) - second);
    paired += result.paired.back().squaredNorm();
    object += 0.5 * result.paired.back().squaredNorm();  // each of the two is half of it away from their mean
  }
  for (const Eigen::Vector3d& landmark : midline) {
    result.unpaired.push_back(plane.signedDistance(landmark));
    object += result.unpaired.back() * result.unpaired.back();
  }
  const auto num_pairs = static_cast<double>(pairs.size()),
             num_all = 2.0 * num_pairs + static_cast<double>(midline.size());
  if (num_pairs > 0.0) result.paired_rms = std::sqrt(paired / num_pairs);
  if (num_all > 0.0) result.object_rms = std::sqrt(object / num_all);
  return result;
}

}  // namespace pcl_symmetry
