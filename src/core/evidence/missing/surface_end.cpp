#include "core/evidence/missing/surface_end.h"

#include <algorithm>
#include <array>
#include <cmath>
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
constexpr int kMostSteps = 200;      // chosen: a bound; clouds apart from each other need fewer
// Share of the squared distance by which a step may still shorten it. derived: the direction is then within the root of
// this, 8 degrees. measured: planes of fold 0 have 0.103 nats with it and with all 200 steps.
constexpr float kLeastGain = 0.02f;
constexpr float kNoDistance = 1.0f;  // spacings. chosen: hulls that near touch or overlap, and the direction is chance

/// Points that are asked again and again which of them is the last one along a direction.
class Extremes {
public:
  explicit Extremes(const Points& points) : points_(points), size_(static_cast<std::size_t>(points.cols())) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Lanes beyond the last point repeat the first one.
      coordinates_[k].assign((size_ + kLanes - 1) / kLanes * kLanes, points(static_cast<Eigen::Index>(k), 0));
      for (std::size_t i = 0; i < size_; ++i)
        coordinates_[k][i] = points(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
    }
    along_.resize(coordinates_[0].size());
  }

  /// The point that is farthest along a direction; of several the first one.
  Eigen::Vector3f last(const Eigen::Vector3f& direction) {
    const float *x = coordinates_[0].data(), *y = coordinates_[1].data(), *z = coordinates_[2].data();
    std::array<float, kLanes> most;
    most.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < along_.size(); i += kLanes) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        const float value = direction.x() * x[i + k] + direction.y() * y[i + k] + direction.z() * z[i + k];
        along_[i + k] = value;
        most[k] = value > most[k] ? value : most[k];
      }
    }
    const auto found = std::find(along_.begin(), along_.end(), *std::max_element(most.begin(), most.end()));
    const auto index = static_cast<std::size_t>(found - along_.begin());
    return points_.col(static_cast<Eigen::Index>(index < size_ ? index : 0));
  }

private:
  static constexpr std::size_t kLanes = 16;  // derived: floats of the widest vectors; narrower ones take two or four

  const Points& points_;
  std::size_t size_;
  std::array<std::vector<float>, 3> coordinates_;
  std::vector<float> along_;
};

/// The direction along which two clouds are farthest apart: that between the closest points of their convex hulls
/// (Gilbert 1966). Where these overlap, a direction in which they overlap little.
Eigen::Vector3f separatingDirection(const Points& points, const Points& piece, float spacing) {
  Extremes of_points(points), of_piece(piece);
  Eigen::Vector3f between = piece.rowwise().mean() - points.rowwise().mean();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector3f nearest = of_piece.last(-between) - of_points.last(between);
    if (between.dot(nearest) >= (1.0f - kLeastGain) * between.squaredNorm()) break;
    const Eigen::Vector3f change = nearest - between;
    const Eigen::Vector3f next = between - std::min(1.0f, between.dot(change) / change.squaredNorm()) * change;
    if (next.norm() < kNoDistance * spacing) break;
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
  const Eigen::Vector3f normal = separatingDirection(points, piece, unit);
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
