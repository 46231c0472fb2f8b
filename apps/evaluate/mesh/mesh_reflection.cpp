#include "evaluate/mesh/mesh_reflection.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

Points sampleScene(const TriangleScene& scene, int num_samples, std::uint64_t seed) {
  const auto size = static_cast<int>(scene.triangles().size());
  Points corners(3, 3 * size);
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < size; ++i) {
    const Triangle& t = scene.triangles()[i];
    corners.middleCols<3>(3 * i) << t.a.cast<float>(), t.b.cast<float>(), t.c.cast<float>();
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return sampleTriangles(corners, triangles, num_samples, seed);
}

}  // namespace

MeshReflection::MeshReflection(const TriangleScene& scene, int num_samples, std::uint64_t seed)
    : distance_(scene), samples_(sampleScene(scene, num_samples, seed)) {}

double MeshReflection::share(const ReflectionPlane& plane, double tolerance, int stride) const {
  int num_samples = 0, num_on_mesh = 0;
  for (Eigen::Index i = 0; i < samples_.cols(); i += stride) {
    num_on_mesh += distance_.within(plane.reflect(samples_.col(i).cast<double>()), tolerance) ? 1 : 0;
    ++num_samples;
  }
  return static_cast<double>(num_on_mesh) / num_samples;
}

ReflectionPlane MeshReflection::refine(const ReflectionPlane& start, double width, double final_width,
                                       int stride) const {
  constexpr int kMaxIterations = 30;  // chosen: most end after ten; twice changes no reference
  constexpr double kReach = 4.0;      // widths; derived: a residual beyond weighs less than 1/289
  // share of the stiffness of the stiffest direction; chosen: only keeps the system regular
  constexpr double kDamping = 1e-6;
  constexpr double kLongestStep = 0.1;  // radians and diagonals; chosen: half is slower, twice leaves the basin
  constexpr double kRest = 1e-9;        // radians and diagonals; chosen: far below what a reference is compared by
  constexpr double kOnSurface = 1e-9;   // diagonals; derived: rounding of double, closer points give no direction
  ReflectionPlane plane = start;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::Vector3d n = plane.normal(), u = n.unitOrthogonal(), v = n.cross(u);
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < samples_.cols(); i += stride) {
      const Eigen::Vector3d x = samples_.col(i).cast<double>();
      const double height = plane.signedDistance(x);
      const Eigen::Vector3d reflected = x - 2.0 * height * n;
      const auto closest = distance_.closest(reflected, kReach * width);
      if (!closest) continue;
      const Eigen::Vector3d away = reflected - closest->point;
      const Eigen::Vector3d m =
          closest->distance > kOnSurface ? Eigen::Vector3d(away / closest->distance) : closest->normal;
      // n moves by a u + b v, the offset by c.
      const double m_n = m.dot(n);
      const Eigen::Vector3d slope(-2.0 * (u.dot(x) * m_n + height * m.dot(u)),
                                  -2.0 * (v.dot(x) * m_n + height * m.dot(v)), 2.0 * m_n);
      const double root = 1.0 / (1.0 + std::pow(closest->distance / width, 2)), weight = root * root;
      h += weight * slope * slope.transpose();
      g += weight * m.dot(away) * slope;
    }
    if (!(h.trace() > 0.0)) break;
    h.diagonal().array() += kDamping * h.trace();
    Eigen::Vector3d step = -h.ldlt().solve(g);
    if (!step.allFinite()) break;
    if (step.norm() > kLongestStep) step *= kLongestStep / step.norm();
    plane = ReflectionPlane((n + step[0] * u + step[1] * v).normalized(), plane.offset() + step[2]);
    if (width == final_width && step.norm() < kRest) break;
    if (step.norm() < width) width = std::max(final_width, 0.5 * width);
  }
  return plane;
}

ReflectionPlane MeshReflection::climb(const ReflectionPlane& start, double tolerance, int stride) const {
  // Steps in tolerances: of the offset, and of the angle in tolerances a diagonal. chosen: the first step moves
  // reflected points by about a tolerance, the last by an eighth; twice as many halvings gain less than the error of
  // the share.
  constexpr double kOffsetStep = 0.5, kAngleStep = 2.0;
  constexpr int kHalvings = 3, kMaxMoves = 40;
  ReflectionPlane best = start;
  double best_share = share(best, tolerance, stride);
  double scale = tolerance;
  for (int halving = 0, moves = 0; halving <= kHalvings && moves < kMaxMoves; ++moves) {
    const ReflectionPlane center = best;
    const Eigen::Vector3d n = center.normal(), u = n.unitOrthogonal(), v = n.cross(u);
    const double angle = kAngleStep * scale, offset = kOffsetStep * scale;
    bool moved = false;
    for (const Eigen::Vector3d& step :
         {Eigen::Vector3d(angle, 0.0, 0.0), Eigen::Vector3d(0.0, angle, 0.0), Eigen::Vector3d(0.0, 0.0, offset)}) {
      for (const double sign : {-1.0, 1.0}) {
        const ReflectionPlane tried((n + sign * (step[0] * u + step[1] * v)).normalized(),
                                    center.offset() + sign * step[2]);
        const double tried_share = share(tried, tolerance, stride);
        if (tried_share <= best_share) continue;
        best_share = tried_share;
        best = tried;
        moved = true;
      }
    }
    if (moved) continue;
    scale *= 0.5;
    ++halving;
  }
  return best;
}

}  // namespace pcl_symmetry::apps
