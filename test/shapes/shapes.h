/// Synthetic shapes with known planes of symmetry.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry::test {

using pcl_symmetry::kDegree;
using pcl_symmetry::kPi;

struct Shape {
  Eigen::Matrix3Xd points;
  std::vector<ReflectionPlane> planes;  ///< all planes of symmetry; those of continuous families are not listed

  /// The points as floats, as in a file.
  Points cloud() const { return points.cast<float>(); }
};

/// Random: each sample is independent of the others. Mirrored: the group repeats the samples of one fundamental domain,
/// so that the planes are symmetries of the point set itself, up to the rounding of its coordinates.
enum class Sampling { Random, Mirrored };

/// Uniform in [-1, 1).
inline double symmetric(RandomStream& random) {
  return 2.0 * random.uniform() - 1.0;
}

/// Standard normal, by Box and Muller.
inline double gaussian(RandomStream& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(2.0 * kPi * random.uniform());
}

/// Uniform in [-1, 1)^3.
inline Eigen::Vector3d randomPoint(RandomStream& random) {
  return Eigen::Vector3d(symmetric(random), symmetric(random), symmetric(random));
}

inline Eigen::Vector3d randomDirection(RandomStream& random) {
  const double z = symmetric(random), angle = 2.0 * kPi * random.uniform();
  return {std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z};
}

/// A uniformly random rotation, then a translation by up to \p distance along each axis.
inline Eigen::Isometry3d randomPose(RandomStream& random, double distance = 3.0) {
  Eigen::Vector4d q;
  for (int i = 0; i < 4; ++i) q[i] = gaussian(random);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  for (int i = 0; i < 3; ++i) pose.translation()[i] = distance * symmetric(random);
  return pose;
}

inline Eigen::Isometry3d randomPose(std::uint64_t seed, double distance = 3.0) {
  RandomStream random(seed, 77);
  return randomPose(random, distance);
}

/// Of a rotation, radians, in [0, pi].
inline double angleOf(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

inline Shape moved(const Shape& shape, const Eigen::Isometry3d& pose) {
  Shape result{pose * shape.points, {}};
  for (const ReflectionPlane& plane : shape.planes) result.planes.push_back(plane.transformed(pose));
  return result;
}

/// \param noise standard deviation of each coordinate.
inline Shape noisy(Shape shape, double noise, std::uint64_t seed) {
  RandomStream random(seed, 5);
  for (Eigen::Index i = 0; i < shape.points.size(); ++i) shape.points(i) += noise * gaussian(random);
  return shape;
}

inline Points moved(const Points& points, const Eigen::Isometry3d& pose) {
  return (pose * points.cast<double>()).cast<float>();
}

inline Shape scaled(const Shape& shape, double scale) {
  Shape result{scale * shape.points, {}};
  for (const ReflectionPlane& plane : shape.planes) result.planes.emplace_back(plane.normal(), scale * plane.offset());
  return result;
}

/// Repeats (Mirrored) or scatters (Random) the points that \p draw gives in the fundamental domain of \p group.
inline Eigen::Matrix3Xd spread(const std::vector<Eigen::Matrix3d>& group, int num_points, Sampling sampling,
                               RandomStream& random, const std::function<Eigen::Vector3d()>& draw) {
  const int order = static_cast<int>(group.size());
  const int num_drawn = sampling == Sampling::Mirrored ? num_points / order : num_points;
  Eigen::Matrix3Xd points(3, sampling == Sampling::Mirrored ? num_drawn * order : num_drawn);
  for (int i = 0; i < num_drawn; ++i) {
    const Eigen::Vector3d p = draw();
    if (sampling == Sampling::Random) {
      points.col(i) = group[random.below(group.size())] * p;
    } else {
      for (int g = 0; g < order; ++g) points.col(i * order + g) = group[g] * p;
    }
  }
  return points;
}

/// A box about the origin with faces across the axes: three planes.
inline Shape box(const Eigen::Vector3d& half, int num_points, Sampling sampling, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Eigen::Matrix3d> group;
  for (int s = 0; s < 8; ++s)
    group.emplace_back(Eigen::Vector3d(s & 1 ? -1 : 1, s & 2 ? -1 : 1, s & 4 ? -1 : 1).asDiagonal());
  const Eigen::Vector3d areas(half.y() * half.z(), half.x() * half.z(), half.x() * half.y());
  Shape shape;
  shape.points = spread(group, num_points, sampling, random, [&] {
    const double u = random.uniform() * areas.sum();
    const int face = u < areas[0] ? 0 : u < areas[0] + areas[1] ? 1 : 2;
    Eigen::Vector3d p(random.uniform() * half.x(), random.uniform() * half.y(), random.uniform() * half.z());
    p[face] = half[face];
    return p;
  });
  for (int axis = 0; axis < 3; ++axis) shape.planes.emplace_back(Eigen::Vector3d::Unit(axis), 0.0);
  return shape;
}

inline Shape box(int num_points, Sampling sampling, std::uint64_t seed) {
  return box({1.0, 0.7, 0.45}, num_points, sampling, seed);
}

/// The faces of a box, outward; bit k of a corner tells on which side across axis k it lies.
constexpr int kBoxQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// The cube [-1, 1]^3: three planes across the axes and six through opposite edges.
inline Shape cube(int num_points, Sampling sampling, std::uint64_t seed) {
  RandomStream random(seed);
  constexpr int kPermutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  std::vector<Eigen::Matrix3d> group;
  for (const auto& permutation : kPermutations) {
    for (int s = 0; s < 8; ++s) {
      Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
      for (int axis = 0; axis < 3; ++axis) g(axis, permutation[axis]) = s >> axis & 1 ? -1.0 : 1.0;
      group.push_back(g);
    }
  }
  Shape shape;
  shape.points = spread(group, num_points, sampling, random, [&] {
    const double u = random.uniform(), v = random.uniform();
    return Eigen::Vector3d(1.0, std::max(u, v), std::min(u, v));
  });
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    shape.planes.emplace_back(Eigen::Vector3d::Unit(a), 0.0);
    shape.planes.emplace_back(Eigen::Vector3d::Unit(a) + Eigen::Vector3d::Unit(b), 0.0);
    shape.planes.emplace_back(Eigen::Vector3d::Unit(a) - Eigen::Vector3d::Unit(b), 0.0);
  }
  return shape;
}

/// A regular n-gon of circumradius 1 swept along z: n planes through the axis and one across it.
inline Shape prism(int n, int num_points, Sampling sampling, std::uint64_t seed, double half_height = 0.8) {
  RandomStream random(seed);
  std::vector<Eigen::Matrix3d> group;
  for (int k = 0; k < n; ++k)
    for (int s = 0; s < 4; ++s)
      group.push_back(Eigen::AngleAxisd(2.0 * kPi * k / n, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                      Eigen::Vector3d(1.0, s & 1 ? -1.0 : 1.0, s & 2 ? -1.0 : 1.0).asDiagonal());
  const double half_side = std::sin(kPi / n), apothem = std::cos(kPi / n);
  const double side_area = half_side * half_height, cap_area = 0.5 * half_side * apothem;
  Shape shape;
  shape.points = spread(group, num_points, sampling, random, [&]() -> Eigen::Vector3d {
    const double across = random.uniform() * half_side;
    if (random.uniform() * (side_area + cap_area) < side_area) return {apothem, across, random.uniform() * half_height};
    const double share = std::sqrt(random.uniform());
    return {apothem * share, across * share, half_height};
  });
  for (int k = 0; k < n; ++k)
    shape.planes.emplace_back(Eigen::Vector3d(-std::sin(kPi * k / n), std::cos(kPi * k / n), 0.0), 0.0);
  shape.planes.emplace_back(Eigen::Vector3d::UnitZ(), 0.0);
  return shape;
}

/// The unit sphere: every plane through its center.
inline Shape sphere(int num_points, std::uint64_t seed) {
  RandomStream random(seed);
  Shape shape{Eigen::Matrix3Xd(3, num_points), {}};
  for (int i = 0; i < num_points; ++i) shape.points.col(i) = randomDirection(random);
  return shape;
}

/// The square from -1 to 1 in z = 0.
inline Points flatSquare(int num_points, std::uint64_t seed) {
  RandomStream random(seed);
  Points points = Points::Zero(3, num_points);
  for (Eigen::Index i = 0; i < num_points; ++i)
    for (int k = 0; k < 2; ++k) points(k, i) = static_cast<float>(symmetric(random));
  return points;
}

/// A closed cylinder of radius 0.6 and height 2 about z: every plane through the axis, and z = 0.
inline Shape cylinder(int num_points, std::uint64_t seed) {
  constexpr double kRadius = 0.6, kHalfHeight = 1.0;
  RandomStream random(seed);
  Shape shape{Eigen::Matrix3Xd(3, num_points), {}};
  for (int i = 0; i < num_points; ++i) {
    const double angle = 2.0 * kPi * random.uniform();
    const bool side = random.uniform() * (2.0 * kHalfHeight + kRadius) < 2.0 * kHalfHeight;
    const double r = side ? kRadius : kRadius * std::sqrt(random.uniform());
    const double z = side ? symmetric(random) * kHalfHeight : random.uniform() < 0.5 ? -kHalfHeight : kHalfHeight;
    shape.points.col(i) = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z);
  }
  return shape;
}

/// A tetrahedron with six different edges: no plane at all.
inline Shape scaleneTetrahedron(int num_points, std::uint64_t seed) {
  const std::array<Eigen::Vector3d, 4> corners = {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(2.0, 0.1, 0.0),
                                                  Eigen::Vector3d(0.4, 1.3, 0.1), Eigen::Vector3d(0.7, 0.2, 0.9)};
  constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  std::array<double, 4> areas;
  for (int f = 0; f < 4; ++f)
    areas[f] =
        (corners[kFaces[f][1]] - corners[kFaces[f][0]]).cross(corners[kFaces[f][2]] - corners[kFaces[f][0]]).norm();
  RandomStream random(seed);
  Shape shape{Eigen::Matrix3Xd(3, num_points), {}};
  for (int i = 0; i < num_points; ++i) {
    double u = random.uniform() * (areas[0] + areas[1] + areas[2] + areas[3]);
    int f = 0;
    while (f < 3 && u >= areas[f]) u -= areas[f++];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    shape.points.col(i) =
        (1.0 - a) * corners[kFaces[f][0]] + a * (1.0 - b) * corners[kFaces[f][1]] + a * b * corners[kFaces[f][2]];
  }
  return shape;
}

/// A sphere with five different bumps in general position: smooth, and no plane at all.
inline Shape asymmetricBlob(int num_points, std::uint64_t seed) {
  const std::array<Eigen::Vector4d, 5> bumps = {
      Eigen::Vector4d(1.0, 0.1, 0.2, 0.9), Eigen::Vector4d(-0.3, 1.0, 0.1, 0.5), Eigen::Vector4d(0.2, -0.4, 1.0, 0.7),
      Eigen::Vector4d(-0.8, -0.5, -0.4, 0.35), Eigen::Vector4d(0.5, 0.6, -0.7, 0.6)};
  Shape shape = sphere(num_points, seed);
  for (int i = 0; i < num_points; ++i) {
    const Eigen::Vector3d direction = shape.points.col(i);
    for (const auto& bump : bumps)
      shape.points.col(i) += bump[3] * std::exp(8.0 * (direction.dot(bump.head<3>().normalized()) - 1.0)) * direction;
  }
  return shape;
}

/// The points for which \p keep holds, in their order.
template <typename Keep>
Points pointsWhere(const Points& points, const Keep& keep) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (keep(Eigen::Vector3f(points.col(i)))) kept.push_back(i);
  return points(Eigen::all, kept);
}

/// One cloud after the other.
template <typename... Clouds>
Points joined(const Clouds&... clouds) {
  Points all(3, (clouds.cols() + ...));
  Eigen::Index at = 0;
  ((all.middleCols(at, clouds.cols()) = clouds, at += clouds.cols()), ...);
  return all;
}

template <typename Number>
double meanOf(const std::vector<Number>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The diagonal of the bounding box, the unit in which offsets are judged.
inline double diagonal(const Points& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cast<double>().norm();
}

/// Difference between two planes.
struct PlaneError {
  double angle;   ///< between the normals as lines, radians
  double offset;  ///< between the signed distances of a point from the two planes
};

inline PlaneError planeError(const ReflectionPlane& a, const ReflectionPlane& b, const Eigen::Vector3d& about) {
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  return {a.angleTo(b), std::abs(a.signedDistance(about) - sign * b.signedDistance(about))};
}

}  // namespace pcl_symmetry::test
