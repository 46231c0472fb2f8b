#include "core/evidence/missing/surface_end.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_symmetry {

namespace {

// Spacings by which the piece may reach behind the last points of the cloud: from the second on it is not beyond them.
// chosen: a ragged cut and the tolerance of a match take two. By cross-validation over whole and cut clouds of fold 0:
// 0.103 nats a plane, 0.105 and 0.110 with one and two spacings less, 0.128 without this test.
constexpr float kInFront = 3.0f, kBehind = 4.0f;
// Mean cosine between the normals of the last points and that of the plane before which they end: up to the first the
// surface runs into the plane, from the second on it closes before it. chosen: as above; 0.104 with 0.05 less of both,
// 0.108 with 0.1 less; 0.5 is that of a sphere that is cut through its center, or of random normals.
constexpr float kRunsInto = 0.65f, kCloses = 0.8f;
constexpr float kLastPoints =
    2.0f;  // spacings before the plane. chosen: one has too few points, three the bend of edges
constexpr double kOutliers = 0.002;   // share of the points. chosen: outliers; twice cuts off small parts
constexpr int kMostSteps = 200;       // chosen: 20 to 60 are made; where both overlap, there is no end
constexpr float kLeastGain = 0.02f;   // share of the distance. chosen: 1 degree of its direction
constexpr float kNoDistance = 1e-4f;  // radii. chosen: far below any spacing

/// The direction along which two clouds are farthest apart: that between the closest points of their convex hulls
/// (Gilbert 1966). Where these overlap, a direction in which they overlap little.
Eigen::Vector3f separatingDirection(const Points& points, const Points& piece) {
  Eigen::Vector3f between = piece.rowwise().mean() - points.rowwise().mean();
  Eigen::VectorXf along;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Index last = 0, first = 0;
    along.noalias() = points.transpose() * between;
    along.maxCoeff(&last);
    along.noalias() = piece.transpose() * between;
    along.minCoeff(&first);
    const Eigen::Vector3f nearest = piece.col(first) - points.col(last);
    if (between.dot(nearest) >= (1.0f - kLeastGain) * between.squaredNorm()) break;
    const Eigen::Vector3f change = nearest - between;
    const Eigen::Vector3f next = between - std::min(1.0f, between.dot(change) / change.squaredNorm()) * change;
    if (next.norm() < kNoDistance) break;
    between = next;
  }
  return between.normalized();
}

/// The distance that all but outliers stay behind.
float lastOf(const Eigen::VectorXf& along) {
  std::vector<float> sorted(along.data(), along.data() + along.size());
  const auto last =
      sorted.begin() + static_cast<std::ptrdiff_t>((1.0 - kOutliers) * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), last, sorted.end());
  return *last;
}

/// 0 up to the first value, 1 from the second on.
float ramp(float value, float none, float all) {
  return std::clamp((value - none) / (all - none), 0.0f, 1.0f);
}

}  // namespace

float beyondEnd(const Points& points, const Points& normals, const Points& piece, double spacing) {
  const auto unit = static_cast<float>(spacing);
  const Eigen::Vector3f normal = separatingDirection(points, piece);
  const Eigen::VectorXf along = points.transpose() * normal;
  const float gap = ((piece.transpose() * normal).minCoeff() - along.maxCoeff()) / unit;
  const float is_beyond = ramp(gap, -kBehind, -kInFront);
  if (is_beyond <= 0.0f) return 0.0f;
  const float end = lastOf(along);
  float cosines = 0.0f, count = 0.0f;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (along[i] < end - kLastPoints * unit) continue;
    cosines += std::abs(normal.dot(normals.col(i)));
    count += 1.0f;
  }
  return is_beyond * ramp(-cosines / count, -kCloses, -kRunsInto);
}

}  // namespace pcl_symmetry
