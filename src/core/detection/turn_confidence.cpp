#include "core/detection/turn_confidence.h"

#include <algorithm>
#include <cmath>

#include "core/detection/turn_confidence_fit.h"

namespace pcl_symmetry {

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
