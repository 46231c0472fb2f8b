#include "core/rotation/rotation_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "pcl_symmetry/core/rotation/rotation_group.h"

namespace pcl_symmetry {

namespace {

constexpr int kPrimes[] = {2, 3, 5, 7};  // axes of greater ones alone are principal axes
constexpr std::size_t kKept = 6;         // of the directions of each order
constexpr double kApart = 0.17;          // radians between them
constexpr double kLeastOverlap = 0.5;    // of a candidate
constexpr double kGoldenAngle = 2.39996322972865332;

/// A Fibonacci half sphere.
Eigen::Vector3d directionAt(int k, int count) {
  const double z = (k + 0.5) / count, ring = std::sqrt(1.0 - z * z), angle = kGoldenAngle * k;
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

/// The directions of the greatest values, apart from each other.
std::vector<int> peaks(const std::vector<double>& values) {
  const int size = static_cast<int>(values.size());
  std::vector<int> order(values.size()), kept;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return values[a] > values[b]; });
  for (const int k : order) {
    if (kept.size() >= kKept || values[k] < kLeastOverlap) break;
    const bool near = std::any_of(kept.begin(), kept.end(), [&](int other) {
      return std::abs(directionAt(k, size).dot(directionAt(other, size))) > std::cos(kApart);
    });
    if (!near) kept.push_back(k);
  }
  return kept;
}

/// Of the turns by 2 pi / n, at n.
std::vector<double> turnOverlaps(const RotationFit& fit, const AxisLineCandidate& line, int max_fold) {
  std::vector<double> overlaps(static_cast<std::size_t>(max_fold) + 1, 0.0);
  for (int n = 2; n <= max_fold; ++n)
    overlaps[n] = fit.overlap(rotationAbout(line.direction, 2.0 * M_PI / n), line.center);
  return overlaps;
}

}  // namespace

std::vector<AxisLineCandidate> searchAxes(const RotationFit& fit, const Eigen::Vector3d& center, int num_directions,
                                          int max_fold, int num_threads) {
  constexpr std::size_t kBlockSize = 100;
  std::vector<AxisLineCandidate> lines;
  for (const int prime : kPrimes) {
    if (prime > max_fold) break;
    std::vector<double> overlaps(static_cast<std::size_t>(num_directions));
    parallelRanges(overlaps.size(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        overlaps[k] =
            fit.overlap(rotationAbout(directionAt(static_cast<int>(k), num_directions), 2.0 * M_PI / prime), center);
    });
    for (const int k : peaks(overlaps)) lines.push_back({directionAt(k, num_directions), center});
  }
  return lines;
}

int likeliestFold(const RotationFit& fit, const AxisLineCandidate& line, int max_fold) {
  const std::vector<double> overlaps = turnOverlaps(fit, line, max_fold);
  return static_cast<int>(std::max_element(overlaps.begin(), overlaps.end()) - overlaps.begin());
}

std::vector<int> likelyFolds(const RotationFit& fit, const AxisLineCandidate& line, int max_fold) {
  constexpr double kBehind = 0.1;
  const std::vector<double> overlaps = turnOverlaps(fit, line, max_fold);
  const double best = *std::max_element(overlaps.begin(), overlaps.end());
  std::vector<int> folds;
  for (int n = 2; n <= max_fold; ++n)
    if (overlaps[n] >= best - kBehind) folds.push_back(n);
  return folds;
}

AxisLineCandidate bestAcross(const RotationFit& fit, const AxisLineCandidate& line, double width, int num_angles,
                             const std::vector<double>& offsets) {
  const Eigen::Vector3d u = line.direction.unitOrthogonal(), v = line.direction.cross(u);
  AxisLineCandidate best{u, line.center};
  double best_overlap = -1.0;
  for (const double offset : offsets) {
    const Eigen::Vector3d center = line.center + offset * line.direction;
    for (int k = 0; k < num_angles; ++k) {
      const double angle = width * k / num_angles;
      const Eigen::Vector3d direction = std::cos(angle) * u + std::sin(angle) * v;
      const double overlap = fit.overlap(rotationAbout(direction, M_PI), center);
      if (overlap <= best_overlap) continue;
      best_overlap = overlap;
      best = {direction, center};
    }
  }
  return best;
}

}  // namespace pcl_symmetry
