#include "bop/surface_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

// Spacings around a sample that count as its plane. derived: no point of an even grid is farther than sqrt(1/2);
// samples drawn at random leave gaps of twice that.
constexpr float kReach = 1.5f;
// Share of the points whose distance is reported. derived: the share of the surface that a symmetry maps onto it.
constexpr double kDeviationShare = 0.97;

}  // namespace

SurfaceEvidence::SurfaceEvidence(Points points, double tolerance)
    : points_(std::move(points)),
      tolerance_(tolerance),
      search_(makeFlannSearch(points_)),
      geometry_(localGeometry(points_, *search_, kNumSupportNeighbours, 1)) {}

std::vector<double> SurfaceEvidence::distances(const Eigen::Isometry3d& motion) const {
  const Points moved = (motion.cast<float>() * points_.colwise().homogeneous()).eval();
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search_->search(moved, 1, closest, sq_distances);
  std::vector<double> distances(closest.size());
  for (std::size_t i = 0; i < closest.size(); ++i) {
    const int j = closest[i];
    const Eigen::Vector3f offset = moved.col(static_cast<Eigen::Index>(i)) - points_.col(j);
    const float off_plane = geometry_.normals.col(j).dot(offset);
    const float along = std::sqrt(std::max(0.0f, offset.squaredNorm() - off_plane * off_plane));
    distances[i] = std::hypot(off_plane, std::max(0.0f, along - kReach * geometry_.spacing[j]));
  }
  return distances;
}

MotionEvidence SurfaceEvidence::of(const Eigen::Isometry3d& motion) const {
  std::vector<double> distances = this->distances(motion);
  MotionEvidence evidence;
  std::size_t num_within = 0;
  for (const double distance : distances) {
    num_within += distance <= tolerance_;
    evidence.mean += distance / static_cast<double>(distances.size());
  }
  evidence.share = static_cast<double>(num_within) / static_cast<double>(distances.size());
  const auto rank = static_cast<std::ptrdiff_t>(kDeviationShare * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  evidence.deviation = distances[rank];
  return evidence;
}

}  // namespace pcl_symmetry::apps
