#include "core/evidence/surface_end.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace pcl_symmetry {

namespace {

// Spacings by which the piece may reach behind the last points of the cloud: from the second on it is not beyond them.
// chosen: a ragged cut and the tolerance of a match take two. By cross-validation over whole and cut clouds of fold 0:
// 0.103 nats a plane, 0.105 and 0.110 with one and two spacings less, 0.110 without this test.
constexpr float kInFront = 3.0f, kBehind = 4.0f;
// Mean cosine between the normals of the last points and that of the plane before which they end: up to the first the
// surface runs into the plane, from the second on it closes before it. chosen: as above; 0.104 with 0.05 less of both,
// 0.108 with 0.1 less; 0.5 is that of a sphere that is cut through its center, or of random normals.
constexpr float kRunsInto = 0.65f, kCloses = 0.8f;
// Spacings before the plane. chosen: a point or two deep, so that the bend of edges does not count; other widths were
// not tried.
constexpr float kLastPoints = 2.0f;
constexpr double kOutliers = 0.002;  // share of the points. chosen: as of planes of cuts, see cut_planes.cpp
// Spacings before the farthest point in which outliers are looked for first. chosen: holds enough points of most ends;
// where it does not, all points are looked at.
constexpr float kOutliersWithin = 8.0f;
constexpr int kMostSteps = 200;  // chosen: a bound; clouds apart from each other need fewer
// Share of the squared distance by which a step may still shorten it. derived: the direction is then within the root of
// this, 8 degrees. measured: planes of fold 0 have 0.103 nats with it and with all 200 steps.
constexpr float kLeastGain = 0.02f;
constexpr float kNoDistance = 1.0f;  // spacings. chosen: hulls that near touch or overlap, and the direction is chance

/// The direction along which two clouds are farthest apart: that between the closest points of their convex hulls
/// (Gilbert 1966). Where these overlap, a direction in which they overlap little.
Eigen::Vector3f separatingDirection(const OutermostPoints& points, const OutermostPoints& piece, float spacing) {
  Eigen::Vector3f between = piece.mean() - points.mean();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector3f nearest = piece.last(-between) - points.last(between);
    if (between.dot(nearest) >= (1.0f - kLeastGain) * between.squaredNorm()) break;
    const Eigen::Vector3f change = nearest - between;
    const Eigen::Vector3f next = between - std::min(1.0f, between.dot(change) / change.squaredNorm()) * change;
    if (next.norm() < kNoDistance * spacing) break;
    between = next;
  }
  return between.normalized();
}

/// The distance along a direction that all but outliers stay behind.
/// \param farthest that of all points.
float lastOf(const OutermostPoints& points, const Eigen::Vector3f& direction, float farthest, float spacing) {
  const auto size = static_cast<std::size_t>(points.size());
  const std::size_t num_beyond = size - 1 - static_cast<std::size_t>((1.0 - kOutliers) * static_cast<double>(size - 1));
  std::vector<float> distances;
  for (const float from : {farthest - kOutliersWithin * spacing, -std::numeric_limits<float>::infinity()}) {
    distances.clear();
    points.visitFrom(direction, from, [&](Eigen::Index, float distance) { distances.push_back(distance); });
    if (distances.size() > num_beyond) break;
  }
  const auto last = distances.begin() + static_cast<std::ptrdiff_t>(num_beyond);
  std::nth_element(distances.begin(), last, distances.end(), std::greater<float>());
  return *last;
}

/// 0 up to the first value, 1 from the second on.
float ramp(float value, float none, float all) {
  return std::clamp((value - none) / (all - none), 0.0f, 1.0f);
}

}  // namespace

float beyondEnd(const OutermostPoints& cloud, const Points& normals, const OutermostPoints& piece, double spacing) {
  const auto unit = static_cast<float>(spacing);
  const Eigen::Vector3f normal = separatingDirection(cloud, piece, unit);
  const float farthest = normal.dot(cloud.last(normal));
  const float gap = (normal.dot(piece.last(-normal)) - farthest) / unit;
  const float is_beyond = ramp(gap, -kBehind, -kInFront);
  if (is_beyond <= 0.0f) return 0.0f;
  float cosines = 0.0f, count = 0.0f;
  cloud.visitFrom(normal, lastOf(cloud, normal, farthest, unit) - kLastPoints * unit, [&](Eigen::Index i, float) {
    cosines += std::abs(normal.dot(normals.col(i)));
    count += 1.0f;
  });
  return is_beyond * ramp(-cosines / count, -kCloses, -kRunsInto);
}

}  // namespace pcl_symmetry
