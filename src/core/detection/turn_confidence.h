#pragma once

#include <vector>

#include "core/detection/turn_evidence.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// What a scan tells about a twofold rotation besides the shares of SymmetryTurn: most of what it maps is hidden, and a
/// flat side that lands on itself confirms little.
struct TurnSigns {
  double grown = 1.0;  ///< extent of the points and their images, in extents of the points; >= 1
  double hold = 1.0;   ///< TurnEvidence::hold()
  /// Least, over pairs of perpendicular planes through the line, of the greater share of the points that one of the two
  /// reflects into free space: most objects with a twofold axis have such planes.
  double planes_off = 0.0;
  /// 1 if a rotation of the same scan fits better, whose line it does not cross at a right angle as twofold axes of
  /// prisms do.
  double beside = 0.0;
};

/// A rotation that was judged, whatever its confidence.
struct JudgedTurn {
  SymmetryTurn turn;  ///< input frame
  TurnSigns signs;
};

/// \param turns of one scan, input frame, with the shares that were seen.
/// \param min_confidence planes are not looked for where the other signs leave a rotation less, see turnConfidence().
/// \param num_threads 0 = one per core.
/// \return one each; other rotations than twofold ones have the defaults.
std::vector<TurnSigns> turnSigns(const TurnEvidence& evidence, const std::vector<SymmetryTurn>& turns,
                                 double min_confidence = 0.0, int num_threads = 1);

/// Rotations whose confidences have numbers of their own: a twofold one hides most of its evidence.
enum class TurnKind { AnyAngle, Half, Folds };

TurnKind kindOf(const SymmetryTurn& turn);

/// Terms of the log odds that rotations which a scan shows are symmetries of the whole object; the first is 1. The
/// numbers that they are multiplied with are fitted by test/benchmark/fit_turns.py.
/// \param turn with the shares that were seen.
std::vector<double> turnOddsTerms(const SymmetryTurn& turn, const TurnSigns& signs);

/// Probability that the rotations map at least 90 % of the whole surface to within 1 % of the diameter of the surface,
/// and all but 1.25 % to within ten times that: the limits of ObjectSymmetryOptions.
/// \param turn with the shares that were seen.
double turnConfidence(const SymmetryTurn& turn, const TurnSigns& signs);

}  // namespace pcl_symmetry
