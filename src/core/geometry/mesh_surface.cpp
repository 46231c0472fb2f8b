#include "pcl_symmetry/core/mesh_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "core/base/check.h"
#include "core/base/small_motion.h"
#include "core/base/statistics.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/triangles.h"

namespace pcl_symmetry {

namespace {

// Lengths are in radii of the bounding ball, unless stated otherwise.
struct MeshRules {
  int samples = 4000;          // samples by which shares are measured: an error of 0.3 % at the limit of 97 %
  int fitted_samples = 1000;   // samples that motions are fitted to, a part of those
  int border_samples = 1000;   // samples of the open borders
  int iterations = 40;         // greatest number of iterations; exact surfaces take three to six
  int max_worse = 3;           // iterations after the best one, at the least width, that end the fit
  double settled = 1e-9;       // length of a step that ends the fit: below what float coordinates resolve
  double longest_step = 0.05;  // greatest step, radians and radii: a step must not reach samples of the other side
  double widths = 2.5;         // width of the weights, medians of the distances: most samples of a symmetry agree
  double first_width = 0.05;   // first least width of the weights: the ends of a bar are few, and far off
  double short_step = 0.1;     // length of a step, in widths, after which the least width is multiplied by `narrower`
  double narrower = 0.25;
  double min_width = 1e-4;     // final least width of the weights, far above rounding
  double exact_cost = 1e-6;    // cost of all samples that is due to rounding
  double touching = 1e-5;      // distance below which its direction is rounding, so that the normal is used
  double stiffness = 1e-9;     // least stiffness of a constrained direction, as a share of the greatest
  double judged_width = 0.01;  // width by which steps are compared: half the default tolerance
  double farthest = 0.45;      // radians and radii: a fit that moves farther has left its symmetry
};
constexpr MeshRules kMesh;

/// Least squares in a small rotation omega of all axes and a small translation t of the center.
struct MotionSums : SmallMotionEquations {
  double cost = 0.0;  // cost by which steps are compared
};

}  // namespace

MotionsAbout MotionsAbout::across(const ReflectionPlane& plane, const Eigen::Vector3d& near) {
  MotionsAbout motions{{}, near - plane.signedDistance(near) * plane.normal()};
  motions.addReflection(plane.normal());
  return motions;
}

void MotionsAbout::addReflection(const Eigen::Vector3d& unit_normal) {
  linear.emplace_back(Eigen::Matrix3d::Identity() - 2.0 * unit_normal * unit_normal.transpose());
}

void MotionsAbout::addRotations(const Eigen::Vector3d& unit_axis) {
  constexpr int kNumRotations = 4;  // by the golden angle: they fit no polygon
  for (int k = 1; k <= kNumRotations; ++k)
    linear.emplace_back(Eigen::AngleAxisd(kGoldenAngle * k, unit_axis).toRotationMatrix());
}

struct MeshSurface::Parts {
  /// Triangles, or edges as triangles without area, each with a direction: the normal, or the direction of the edge.
  struct Surface {
    std::unique_ptr<TriangleTree> tree;
    Points samples, directions;
  };

  BoundingBall ball;
  Points corners;  // three corners for each triangle, in radii about the center of the ball, like the surfaces
  std::vector<Eigen::Vector3i> triangles;
  Surface faces, borders;  // the borders may have no tree
  std::once_flag has_trees;

  /// Builds the trees on first use: many meshes have no symmetry to refine.
  const Parts& withTrees();

  /// The image of a sample, and the vector to it from the closest point.
  struct Match {
    Eigen::Vector3d image = Eigen::Vector3d::Zero(), apart = Eigen::Vector3d::Constant(1e3), direction;
  };
  using Matches = std::vector<Match>;

  /// \param[in,out] matches one for each sample; their closest points under a similar motion serve as guesses.
  /// \param reach radii; samples farther from the surface keep their match.
  /// \param max_far if more samples than this are farther, the remaining ones keep their match.
  static void match(const Surface& surface, const Eigen::Matrix3d& linear, const Eigen::Vector3d& center,
                    Matches& matches, double reach = std::numeric_limits<double>::infinity(),
                    int max_far = kMesh.samples) {
    const double slack = 1e-4;  // radii, more than rounding: the closest point itself is within the guess
    int num_far = 0;
    for (std::size_t i = 0; i < matches.size() && num_far <= max_far; ++i) {
      const Eigen::Vector3d x = center + linear * (surface.samples.col(i).cast<double>() - center);
      const double guess = std::min(reach, (x - matches[i].image + matches[i].apart).norm()) + slack;
      const ClosestOnTriangles closest = surface.tree->closestTo(x.cast<float>(), static_cast<float>(guess * guess));
      if (closest.triangle < 0)
        ++num_far;
      else
        matches[i] = {x, x - closest.point.cast<double>(), surface.directions.col(closest.triangle).cast<double>()};
    }
  }

  /// \param min_width least width of the weights.
  /// \param[in,out] matches matches of each motion.
  void addTo(MotionSums& sums, const Surface& surface, const MotionsAbout& motions, double min_width,
             std::vector<Matches>& matches) const {
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const Eigen::Matrix3d& linear = motions.linear[k];
      Matches& found = matches[k];
      match(surface, linear, motions.center, found);
      std::vector<double> distances;
      for (const Match& match : found) distances.push_back(match.apart.norm());
      const double sigma = std::max(min_width, kMesh.widths * median(distances));
      // x' = R (x - c) + c moves with exp(omega) R exp(-omega) and c + t by ((1 - R det R) omega) x (x' - c) +
      // (1 - R) t: a reflection is -1 times a rotation.
      const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d of_translation = (one - linear).transpose(),
                            of_rotation = (one - linear.determinant() * linear).transpose();
      for (std::size_t i = 0; i < found.size(); ++i) {
        const Match& match = found[i];
        const auto gaussian = [&](double width) { return std::exp(-distances[i] * distances[i] / (width * width)); };
        const bool is_border = &surface == &borders;
        const Eigen::Vector3d& face = match.direction;
        Eigen::Vector3d across = is_border ? face.unitOrthogonal() : face;
        if (distances[i] > kMesh.touching) across = match.apart / distances[i];
        const auto add = [&](const Eigen::Vector3d& m) {
          Vector6d slope;
          slope << of_rotation * (match.image - motions.center).cross(m), of_translation * m;
          sums.h += gaussian(sigma) * slope * slope.transpose();
          sums.g += gaussian(sigma) * m.dot(match.apart) * slope;
        };
        add(across);
        if (is_border) add(across.cross(face).normalized());
        sums.cost += 1.0 - gaussian(kMesh.judged_width);
      }
    }
  }
};

MeshSurface::MeshSurface(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles)
    : parts_(std::make_shared<Parts>()) {
  std::vector<Eigen::Vector3i> faces = finiteTriangles(vertices, triangles);
  Points corners(3, 3 * faces.size());
  for (int t = 0; t < static_cast<int>(faces.size()); ++t) {
    for (int k = 0; k < 3; ++k) corners.col(3 * t + k) = vertices.col(faces[t][k]);
    faces[t] << 3 * t, 3 * t + 1, 3 * t + 2;
  }
  parts_->ball = boundingBall(corners);
  check(parts_->ball.radius > 0.0, "extent of the mesh", parts_->ball.radius, "> 0");
  parts_->corners = normalizePoints(corners, parts_->ball.center, parts_->ball.radius);
  parts_->triangles = std::move(faces);
  // Motions are fitted to the first samples, which are spread over the surface.
  const int stride = kMesh.samples / kMesh.fitted_samples;
  const Points samples = sampleTriangles(parts_->corners, parts_->triangles, kMesh.samples);
  parts_->faces.samples = samples;
  for (int i = 0; i < kMesh.samples; ++i)
    parts_->faces.samples.col(i / stride + (i % stride) * kMesh.fitted_samples) = samples.col(i);
}

const MeshSurface::Parts& MeshSurface::Parts::withTrees() {
  std::call_once(has_trees, [this] {
    faces.tree = std::make_unique<TriangleTree>(corners, triangles);
    faces.directions.resize(3, triangles.size());
    for (Eigen::Index t = 0; t < faces.directions.cols(); ++t) {
      const Eigen::Vector3f u = corners.col(3 * t + 1) - corners.col(3 * t),
                            v = corners.col(3 * t + 2) - corners.col(3 * t);
      faces.directions.col(t) = u.cross(v).stableNormalized();
    }
    std::vector<Eigen::Vector3i> edges;
    std::vector<double> length_up_to{0.0};
    for (const auto& [a, b] : openEdges(corners, triangles)) {
      edges.emplace_back(a, b, b);
      length_up_to.push_back(length_up_to.back() + (corners.col(b) - corners.col(a)).norm());
    }
    if (!(length_up_to.back() > 0.0)) return;
    borders.tree = std::make_unique<TriangleTree>(corners, edges);
    borders.directions.resize(3, edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
      borders.directions.col(e) = (corners.col(edges[e][1]) - corners.col(edges[e][0])).normalized();
    borders.samples.resize(3, kMesh.border_samples);
    std::size_t e = 0;
    for (int i = 0; i < kMesh.border_samples; ++i) {
      const double target = (i + 0.5) * length_up_to.back() / kMesh.border_samples;
      while (e + 1 < edges.size() && length_up_to[e + 1] < target) ++e;
      borders.samples.col(i) =
          corners.col(edges[e][0]) + static_cast<float>(target - length_up_to[e]) * borders.directions.col(e);
    }
  });
  return *this;
}

MeshSurface::Placement MeshSurface::fitted(const MotionsAbout& motions) const {
  const Parts& parts = parts_->withTrees();
  const BoundingBall& ball = parts.ball;
  MotionsAbout moving{motions.linear, (motions.center - ball.center) / ball.radius};
  const Eigen::Vector3d start = moving.center;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Placement best{rotation, motions.center};
  double least = std::numeric_limits<double>::infinity(), width = kMesh.first_width;
  std::vector<Parts::Matches> on_faces(motions.linear.size(), Parts::Matches(kMesh.fitted_samples)),
      on_borders(motions.linear.size(), Parts::Matches(kMesh.border_samples));
  int num_worse = 0;  // iterations since the best one
  for (int i = 0; i < kMesh.iterations; ++i) {
    MotionSums sums;
    parts.addTo(sums, parts.faces, moving, width, on_faces);
    if (parts.borders.tree) parts.addTo(sums, parts.borders, moving, width, on_borders);
    const bool is_near =
        Eigen::AngleAxisd(rotation).angle() < kMesh.farthest && (moving.center - start).norm() < kMesh.farthest;
    if (!is_near) break;
    // Of equally good steps, the last is the most exact.
    if (sums.cost <= least * (1.0 + kMesh.min_width) + kMesh.exact_cost) {
      best = {rotation, ball.center + ball.radius * moving.center};
      least = std::min(least, sums.cost);
      num_worse = 0;
    } else if (++num_worse >= kMesh.max_worse && width == kMesh.min_width) {
      break;
    }
    const Vector6d step = smallMotion(sums, kMesh.stiffness, kMesh.longest_step);
    const bool is_done = step.norm() < kMesh.settled && (width == kMesh.min_width || sums.cost < kMesh.exact_cost);
    if (is_done || !step.allFinite()) break;
    if (step.norm() < kMesh.short_step * width) width = std::max(kMesh.min_width, kMesh.narrower * width);
    const Eigen::Matrix3d next = rotationBy(step.head<3>());
    rotation = next * rotation;
    for (Eigen::Matrix3d& linear : moving.linear) linear = next * linear * next.transpose();
    moving.center += step.tail<3>();
  }
  return best;
}

ReflectionPlane MeshSurface::fitted(const ReflectionPlane& plane) const {
  const Placement placed = fitted(MotionsAbout::across(plane, parts_->ball.center));
  const Eigen::Vector3d normal = placed.rotation * plane.normal();
  return {normal, normal.dot(placed.center)};
}

MeshShares MeshSurface::shares(const MotionsAbout& motions, double tolerance, std::optional<double> min_share) const {
  const Parts& parts = parts_->withTrees();
  const double reach = min_share ? tolerance / parts.ball.radius : std::numeric_limits<double>::infinity();
  const int max_far = 1 + static_cast<int>((1.0 - min_share.value_or(0.0)) * kMesh.samples);
  MeshShares worst;
  for (const Eigen::Matrix3d& linear : motions.linear) {
    std::vector<double> distances;
    double sq_sum = 0.0, within = 0.0;
    Parts::Matches matches(kMesh.samples);
    Parts::match(parts.faces, linear, (motions.center - parts.ball.center) / parts.ball.radius, matches, reach,
                 max_far);
    for (const Parts::Match& match : matches) {
      distances.push_back(parts.ball.radius * match.apart.norm());
      if (distances.back() > tolerance) continue;
      within += 1.0;
      sq_sum += distances.back() * distances.back();
    }
    const auto quantile = distances.begin() + static_cast<std::ptrdiff_t>(kSymmetricShare * kMesh.samples);
    std::nth_element(distances.begin(), quantile, distances.end());
    worst.share = std::min(worst.share, within / kMesh.samples);
    worst.deviation = std::max(worst.deviation, *quantile);
    if (within > 0.0) worst.residual = std::max(worst.residual, std::sqrt(sq_sum / within));
  }
  return worst;
}

MeshShares MeshSurface::shares(const ReflectionPlane& plane, double tolerance, std::optional<double> min_share) const {
  return shares(MotionsAbout::across(plane, parts_->ball.center), tolerance, min_share);
}

const BoundingBall& MeshSurface::ball() const {
  return parts_->ball;
}

int MeshSurface::numSamples() const {
  return kMesh.samples;
}

}  // namespace pcl_symmetry
