#include "core/detection/turn_confidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/detection/turn_confidence_fit.h"
#include "core/detection/turn_evidence.h"
#include "core/geometry/diameter.h"

namespace pcl_symmetry {

namespace {

// Pairs of perpendicular planes through a line that are screened, and tolerances of the screening. chosen: half the
// last step is 0.9 degrees, by which a point at half a radius moves 0.8 tolerances; half misses planes, twice takes
// twice the time.
constexpr int kNumPlanePairs = 24;
constexpr double kPlaneSlack = 2.0;
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
  constexpr double kStep = 0.5 * kPi / kNumPlanePairs;  // radians. derived: pairs repeat after a right angle
  const auto cost = [&](double angle) {
    double sum = 0.0;
    for (const double turned : {angle, angle + 0.5 * kPi}) {
      const TurnShares shares = evidence.roughly(mirrorThrough(line, turned), kPlaneSlack, 1.0, 1.0);
      sum += shares.off - kLandedCounts * shares.on;
    }
    return sum;
  };
  double best = 0.0, least = cost(0.0);
  const auto take = [&](double angle) {
    const double of_angle = cost(angle);
    if (of_angle >= least) return;
    least = of_angle;
    best = angle;
  };
  for (int k = 1; k < kNumPlanePairs; ++k) take(k * kStep);
  const double coarse = best;
  for (const double beside : {-0.5 * kStep, 0.5 * kStep}) take(coarse + beside);
  return std::max(evidence.exactly(mirrorThrough(line, best)).off,
                  evidence.exactly(mirrorThrough(line, best + 0.5 * kPi)).off);
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

std::vector<TurnSigns> turnSigns(const TurnEvidence& evidence, const std::vector<SymmetryTurn>& turns,
                                 double min_confidence, int num_threads) {
  const NormalizedCloud& cloud = evidence.cloud();
  std::vector<TurnSigns> signs(turns.size());
  const auto best = std::max_element(turns.begin(), turns.end(), [](const SymmetryTurn& a, const SymmetryTurn& b) {
    return marginOf(a) < marginOf(b);
  });
  parallelBlocks(turns.size(), num_threads, [&](std::size_t i) {
    if (turns[i].fold != 2) return;
    const Line3d line = cloud.lineOf(turns[i]);
    signs[i].grown = grownBy(cloud, Eigen::Affine3d(turnAbout(line, kPi)));
    signs[i].hold = evidence.hold(line, kPi);
    const bool is_best = marginOf(turns[i]) >= marginOf(*best);
    signs[i].beside = is_best || crossesUpright(line, cloud.lineOf(*best)) ? 0.0 : 1.0;
    // Planes only speak against a turn, and take most of the time.
    if (turnConfidence(turns[i], signs[i]) >= min_confidence) signs[i].planes_off = planesOff(evidence, line);
  });
  return signs;
}

namespace {

// Share of the points by which turns halfway may throw more into empty space and still say more. chosen: half hides
// what sets shallow folds apart from round bodies, beyond it all folds are alike.
constexpr double kMostHalfway = 0.3;
// Share of the points that counts as little. derived: two of a thousand points, what chance takes.
constexpr double kLittleShare = 2e-3;
// The same of planes, which are screened at steps. chosen: what half a step throws off; half and twice fit as well.
constexpr double kLittleOfPlanes = 5e-3;
// Stiffness of a line that is hardly held. chosen: sheets have 1e-9 to 1e-4, boxes 0.05; ten times as much fits as
// well.
constexpr double kLittleHold = 1e-3;

}  // namespace

TurnKind kindOf(const SymmetryTurn& turn) {
  return turn.fold == 0 ? TurnKind::AnyAngle : turn.fold == 2 ? TurnKind::Half : TurnKind::Folds;
}

std::vector<double> turnOddsTerms(const SymmetryTurn& turn, const TurnSigns& signs) {
  const double off = std::log1p(turn.off / kLittleShare), far = std::log1p(turn.far / kLittleShare);
  switch (kindOf(turn)) {
    case TurnKind::Half:  // without what is far off: what the object grows by says that, and off does
      return {1.0,
              off,
              1.0 - turn.support,
              std::log(signs.grown),
              -std::log1p(signs.hold / kLittleHold),
              std::log1p(signs.planes_off / kLittleOfPlanes),
              signs.beside};
    case TurnKind::Folds:
      return {1.0, off, far, 1.0 - turn.support, std::min(kMostHalfway, turn.halfway - turn.off), 1.0 / turn.fold};
    default:
      return {1.0, off, far, 1.0 - turn.support};
  }
}

double turnConfidence(const SymmetryTurn& turn, const TurnSigns& signs) {
  const std::vector<double> terms = turnOddsTerms(turn, signs);
  const std::vector<double>& numbers = kTurnConfidenceFit[static_cast<std::size_t>(kindOf(turn))];
  double log_odds = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) log_odds += numbers[k] * terms[k];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace pcl_symmetry
