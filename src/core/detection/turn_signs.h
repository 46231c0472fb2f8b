#pragma once

#include <vector>

#include "core/detection/turn_evidence.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// What a scan says of a half turn besides the shares of SymmetryTurn: most of what it maps is hidden, and a flat side
/// that lands on itself confirms little.
struct TurnSigns {
  double grown = 1.0;  ///< extent of the points and their images, in extents of the points; >= 1
  double hold = 1.0;   ///< TurnEvidence::hold()
  /// Share of the points that the worse of two perpendicular planes through the line mirrors to where the scanner saw
  /// nothing, of the pair with the least: most objects with a half turn have such planes.
  double planes_off = 0.0;
  /// 1 if a turn of the same scan fits better, whose line it does not cross at a right angle as half turns of prisms
  /// do.
  double beside = 0.0;
};

/// A turn that a scan was asked about, whatever its confidence.
struct JudgedTurn {
  SymmetryTurn turn;  ///< input frame
  TurnSigns signs;
};

/// \param turns of one scan, input frame, with the shares that were seen.
/// \param min_confidence planes are not looked for where the other signs leave a turn less, see turnConfidence().
/// \param num_threads 0 = one per core.
/// \return one each; other turns than half turns have the defaults.
std::vector<TurnSigns> turnSigns(const TurnEvidence& evidence, const std::vector<SymmetryTurn>& turns,
                                 double min_confidence = 0.0, int num_threads = 1);

}  // namespace pcl_symmetry
