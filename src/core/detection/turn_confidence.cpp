#include "core/detection/turn_confidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/logistic.h"
#include "core/base/parallel.h"
#include "core/detection/detection_rules.h"
#include "core/detection/turn_confidence_fit.h"
#include "core/detection/turn_evidence.h"
#include "core/geometry/diameter.h"

namespace pcl_symmetry {

namespace {

/// TurnSigns::planes_off.
double planesOff(const TurnEvidence& evidence, const Line3d& line) {
  constexpr double kStep =
      0.5 * kPi / kDetection.rotations.num_plane_pairs;  // radians. Pairs repeat after a right angle
  const auto cost = [&](double angle) {
    double sum = 0.0;
    for (const double turned : {angle, angle + 0.5 * kPi}) {
      const TurnShares shares =
          evidence.roughly(planeThrough(line, turned).reflection(), kDetection.rotations.plane_slack, 1.0, 1.0);
      sum += shares.off - kDetection.rotations.landed_counts * shares.on;
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
  for (int k = 1; k < kDetection.rotations.num_plane_pairs; ++k) take(k * kStep);
  const double coarse = best;
  for (const double beside : {-0.5 * kStep, 0.5 * kStep}) take(coarse + beside);
  return std::max(evidence.exactly(planeThrough(line, best).reflection()).off,
                  evidence.exactly(planeThrough(line, best + 0.5 * kPi).reflection()).off);
}

/// TurnSigns::grown.
double grownBy(const NormalizedCloud& cloud, const Eigen::Affine3d& turn) {
  const Eigen::Index size = cloud.points.cols();
  Points both(3, 2 * size);
  both.leftCols(size) = cloud.points;
  both.rightCols(size) = turn.cast<float>() * cloud.points;
  return std::max(1.0, diameter(both) / cloud.extent);
}

/// Whether two lines, normalized frame, cross at a right angle.
bool crossesUpright(const Line3d& a, const Line3d& b) {
  const Eigen::Vector3d across = a.direction().cross(b.direction()).normalized();
  return std::abs(a.direction().dot(b.direction())) < std::sin(kDetection.rotations.upright_angle) &&
         std::abs(across.dot(a.origin() - b.origin())) < kDetection.rotations.crossing_gap;
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
    // Planes are evidence only against a rotation, and take most of the time.
    if (turnConfidence(turns[i], signs[i]) >= min_confidence) signs[i].planes_off = planesOff(evidence, line);
  });
  return signs;
}

TurnKind kindOf(const SymmetryTurn& turn) {
  return turn.fold == 0 ? TurnKind::AnyAngle : turn.fold == 2 ? TurnKind::Half : TurnKind::Folds;
}

std::vector<double> turnOddsTerms(const SymmetryTurn& turn, const TurnSigns& signs) {
  const double off = std::log1p(turn.off / kDetection.rotations.little_share),
               far = std::log1p(turn.far / kDetection.rotations.little_share);
  switch (kindOf(turn)) {
    case TurnKind::Half:  // without what is far off: what the object grows by says that, and off does
      return {1.0,
              off,
              1.0 - turn.support,
              std::log(signs.grown),
              -std::log1p(signs.hold / kDetection.rotations.little_hold),
              std::log1p(signs.planes_off / kDetection.rotations.little_of_planes),
              signs.beside};
    case TurnKind::Folds:
      return {1.0,
              off,
              far,
              1.0 - turn.support,
              std::min(kDetection.rotations.most_halfway, turn.halfway - turn.off),
              1.0 / turn.fold};
    default:
      return {1.0, off, far, 1.0 - turn.support};
  }
}

double turnConfidence(const SymmetryTurn& turn, const TurnSigns& signs) {
  const std::vector<double> terms = turnOddsTerms(turn, signs);
  const std::vector<double>& numbers = kTurnConfidenceFit[static_cast<std::size_t>(kindOf(turn))];
  double log_odds = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) log_odds += numbers[k] * terms[k];
  return logistic(log_odds);
}

}  // namespace pcl_symmetry
