#include "core/detection/scan_axes/turn_signs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "core/detection/scan_axes/turn_limits.h"
#include "core/neighbours/diameter.h"

namespace pcl_symmetry {

namespace {

// Planes through a line that are screened, and tolerances of the screening. chosen: half a step is 1.9 degrees, by
// which a point at half a radius moves 1.6 of the tolerances; half misses planes, twice takes twice the time.
constexpr int kNumScreenedPlanes = 48;
constexpr double kPlaneSlack = 2.0;
constexpr int kPairStep = kNumScreenedPlanes / 2;  // derived: planes of a pair are perpendicular
// Radians and radii that lines may miss a right angle and each other by. chosen: lines of scans are off by a third of
// this; twice lets chance cross.
constexpr double kUprightAngle = 6.0 * kDegree, kCrossingGap = 0.06;
// What lands on the surface counts this much of what is thrown off it. chosen: it decides among planes that throw
// nothing off; at one, a great side decides.
constexpr double kLandedCounts = 0.1;

/// Reflection in the plane through a line.
Eigen::Affine3d mirrorThrough(const Line3d& line, double angle) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  const Eigen::Vector3d normal = std::cos(angle) * u + std::sin(angle) * v;
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear() -= 2.0 * normal * normal.transpose();
  mirror.translation() = 2.0 * normal.dot(line.origin()) * normal;
  return mirror;
}

/// TurnSigns::planes_off.
double planesOff(const TurnEvidence& evidence, const Line3d& line) {
  std::array<double, kNumScreenedPlanes> costs;
  for (int k = 0; k < kNumScreenedPlanes; ++k) {
    const TurnShares shares =
        evidence.roughly(mirrorThrough(line, kPi * k / kNumScreenedPlanes), kPlaneSlack, 1.0, 1.0);
    costs[k] = shares.off - kLandedCounts * shares.on;
  }
  int best = 0;
  for (int k = 1; k < kPairStep; ++k)
    if (costs[k] + costs[k + kPairStep] < costs[best] + costs[best + kPairStep]) best = k;
  const double angle = kPi * best / kNumScreenedPlanes;
  return std::max(evidence.exactly(mirrorThrough(line, angle)).off,
                  evidence.exactly(mirrorThrough(line, angle + 0.5 * kPi)).off);
}

/// TurnSigns::grown.
double grownBy(const NormalizedCloud& cloud, const Eigen::Affine3d& turn) {
  const Eigen::Index size = cloud.points.cols();
  Points both(3, 2 * size);
  both.leftCols(size) = cloud.points;
  both.rightCols(size) = turn.cast<float>() * cloud.points;
  return std::max(1.0, diameter(both) / cloud.extent);
}

/// Whether two lines, normalised frame, cross at a right angle.
bool crossesUpright(const Line3d& a, const Line3d& b) {
  const Eigen::Vector3d across = a.direction().cross(b.direction()).normalized();
  return std::abs(a.direction().dot(b.direction())) < std::sin(kUprightAngle) &&
         std::abs(across.dot(a.origin() - b.origin())) < kCrossingGap;
}

}  // namespace

std::vector<TurnSigns> turnSigns(const TurnEvidence& evidence, const std::vector<SymmetryTurn>& turns) {
  const NormalizedCloud& cloud = evidence.cloud();
  const auto lineOf = [&](const SymmetryTurn& turn) {
    return Line3d((turn.point - cloud.center) / cloud.scale, turn.direction);
  };
  std::vector<TurnSigns> signs(turns.size());
  const auto best = std::max_element(turns.begin(), turns.end(), [](const SymmetryTurn& a, const SymmetryTurn& b) {
    return marginOf(a) < marginOf(b);
  });
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i].fold != 2) continue;
    const Line3d line = lineOf(turns[i]);
    signs[i].grown = grownBy(cloud, Eigen::Affine3d(turnAbout(line, kPi)));
    signs[i].hold = evidence.hold(line, kPi);
    signs[i].planes_off = planesOff(evidence, line);
    const bool is_best = marginOf(turns[i]) >= marginOf(*best);
    signs[i].beside = is_best || crossesUpright(line, lineOf(*best)) ? 0.0 : 1.0;
  }
  return signs;
}

}  // namespace pcl_symmetry
