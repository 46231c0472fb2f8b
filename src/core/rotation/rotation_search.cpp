#include "core/rotation/rotation_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/rotation_group.h"

namespace pcl_symmetry {

namespace {

// Orders of the turns that axes are searched by. derived: a rotation of any order has a power of prime order. An axis
// whose only primes are greater ones is the single axis of its shape, hence a principal axis of the points.
constexpr int kPrimes[] = {2, 3, 5, 7};
// Directions kept for each order. derived: the icosahedron has six axes of order 5; those of lower order follow from
// them.
constexpr std::size_t kKept = 6;
// Radians, least angle between kept directions. chosen: half keeps one axis twice, twice merges axes of large groups.
constexpr double kApart = 0.17;
// Least overlap of a line. chosen: half tries lines in vain, at 4/3 features that may be ignored hide lines.
constexpr double kLeastOverlap = 0.6;
// Points that are asked first, and the overlap that they need. chosen: 0.6 less three standard errors of 0.06; half
// asks more directions in vain, at twice of the points most of the gain is lost.
constexpr int kFirstPoints = 48;
constexpr double kFirstOverlap = 0.42;
// Overlap behind that of the best turn at which a smaller fold is as likely. chosen: half prefers small angles, twice
// takes folds that are none.
constexpr double kBehind = 0.05;
// Folds that are likely whatever others are: their turns tell best where an axis lies. derived: the orders of all axes
// of the polyhedral groups, and of most objects.
constexpr int kSmallFold = 6;
// Overlap that half a turn may have beyond a turn that is one of a fold. chosen: chance between 256 points; at half
// chance drops folds, at twice small angles pass.
constexpr double kAllowance = 0.03;
// Radians and radii, lines closer than this are one. chosen: half fits one axis twice, twice merges two axes.
constexpr double kSameLine = 0.05;
// Directions in one block of a thread. chosen: half adds overhead, twice leaves threads idle; results do not depend on
// it.
constexpr std::size_t kBlockSize = 100;

Eigen::Vector3d directionAt(int k, int count) {
  return spiralDirection(k, count, kGoldenAngle * k);
}

/// The overlap of a rotation; 0 where a part of the points already says that it is too small.
double overlapOrLess(const RotationFit& fit, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) {
  return fit.overlap(rotation, center, kFirstPoints) < kFirstOverlap ? 0.0 : fit.overlap(rotation, center);
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

/// Overlaps of the turns by 2 pi / n about a line, at index n; 0 where half of that turn overlaps better. Turns by
/// small angles overlap well with any shape, and better the smaller they are.
std::vector<double> foldOverlaps(const RotationFit& fit, const Line3d& line, int max_fold) {
  std::vector<double> overlaps(static_cast<std::size_t>(max_fold) + 1, 0.0);
  for (int n = 2; n <= max_fold; ++n) {
    const double own = fit.overlap(rotationAbout(line.direction(), 2.0 * kPi / n), line.origin());
    const double half = fit.overlap(rotationAbout(line.direction(), kPi / n), line.origin());
    overlaps[n] = own >= half - kAllowance ? own : 0.0;
  }
  return overlaps;
}

/// Lines through one center about which a turn of prime order overlaps most.
std::vector<Line3d> linesThrough(const Eigen::Vector3d& center, const RotationFit& fit, int num_directions,
                                 int max_fold, int num_threads) {
  std::vector<Line3d> lines;
  for (const int prime : kPrimes) {
    if (prime > max_fold) break;
    std::vector<double> overlaps(static_cast<std::size_t>(num_directions));
    parallelRanges(overlaps.size(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        overlaps[k] = overlapOrLess(
            fit, rotationAbout(directionAt(static_cast<int>(k), num_directions), 2.0 * kPi / prime), center);
    });
    for (const int k : peaks(overlaps)) lines.emplace_back(center, directionAt(k, num_directions));
  }
  return lines;
}

}  // namespace

std::vector<Eigen::Vector3d> axisCenters(const RotationFit& fit) {
  const Eigen::Vector3d mass = centerOfMass(fit.points());
  return mass.norm() > kSameLine ? std::vector<Eigen::Vector3d>{mass, Eigen::Vector3d::Zero()} : std::vector{mass};
}

std::vector<Line3d> principalLines(const RotationFit& fit) {
  const PrincipalAxes principal = principalAxes(fit.points());
  std::vector<Line3d> lines;
  const std::vector<Eigen::Vector3d> centers = axisCenters(fit);
  if (centers.size() > 1) lines.emplace_back(principal.center, principal.center.normalized());
  for (const Eigen::Vector3d& center : centers)
    for (int k = 0; k < 3; ++k) lines.emplace_back(center, principal.axes.col(k));
  return lines;
}

std::vector<Line3d> axisLineCandidates(const RotationFit& fit, int num_directions, int max_fold, int num_threads) {
  std::vector<Line3d> lines;
  for (const Eigen::Vector3d& center : axisCenters(fit)) {
    const auto found = linesThrough(center, fit, num_directions, max_fold, num_threads);
    lines.insert(lines.end(), found.begin(), found.end());
  }
  return lines;
}

bool isKnown(const std::vector<Line3d>& lines, const Line3d& line) {
  return std::any_of(lines.begin(), lines.end(), [&](const Line3d& other) {
    return angleBetweenLines(other.direction(), line.direction()) < kSameLine &&
           (line.origin() - other.origin()).cross(other.direction()).norm() < kSameLine;
  });
}

double angleBetweenLines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

std::vector<int> likelyFolds(const RotationFit& fit, const Line3d& line, int max_fold) {
  const std::vector<double> overlaps = foldOverlaps(fit, line, max_fold);
  const auto least_near_best = [&](int last) {
    const double best = *std::max_element(overlaps.begin(), overlaps.begin() + last + 1);
    int n = 2;
    while (overlaps[n] < best - kBehind) ++n;
    return n;
  };
  const int small = least_near_best(std::min(kSmallFold, max_fold)), any = least_near_best(max_fold);
  return any == small ? std::vector{small} : std::vector{small, any};
}

Line3d bestAcross(const RotationFit& fit, const Line3d& line, double width, int num_angles,
                  const std::vector<double>& offsets) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  Line3d best(line.origin(), u);
  double best_overlap = -1.0;
  for (const double offset : offsets) {
    const Eigen::Vector3d center = line.origin() + offset * line.direction();
    for (int k = 0; k < num_angles; ++k) {
      const double angle = width * k / num_angles;
      const Eigen::Vector3d direction = std::cos(angle) * u + std::sin(angle) * v;
      const double overlap = fit.overlap(rotationAbout(direction, kPi), center);
      if (overlap <= best_overlap) continue;
      best_overlap = overlap;
      best = Line3d(center, direction);
    }
  }
  return best;
}

}  // namespace pcl_symmetry
