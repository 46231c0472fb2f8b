#pragma once

#include <vector>

#include "core/detection/plane_measure.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// From evidence to answers: the one place that says what is a symmetry, what is possible, and what comes first
/// (core/evidence/README.md).
class PlaneDecision {
public:
  /// \param cloud,measure,options must outlive this object.
  PlaneDecision(const NormalizedCloud& cloud, const PlaneMeasure& measure, const DetectionOptions& options)
      : cloud_(cloud), measure_(measure), options_(options) {}

  /// \return the plane in the input frame, with its confidence and kind.
  SymmetryPlane decide(PlaneRecord record) const;

  /// Gives a plane another confidence, and the kind that follows from it.
  /// \param plane input frame.
  void decideBy(double confidence, SymmetryPlane& plane) const;

  /// Whether a plane explains all of a whole cloud, so that nothing of it is missing.
  bool explainsAll(const SymmetryPlane& plane) const;

  /// Whether too many points are off for a possible symmetry where nothing is missing.
  bool isHopeless(const Candidate& candidate) const;

  /// Where a plane explains all of a cloud, nothing of it is missing: doubts planes that need a missing piece (the
  /// plane across an open cup needs a lid).
  void preferWhole(std::vector<SymmetryPlane>& planes) const;

  /// A scan or a cut hides a part of an object, and many planes are tried: those beside the best one are symmetries
  /// less often.
  /// \param has_family an axis or a center was found, which is better than all planes.
  void preferBest(std::vector<SymmetryPlane>& planes, bool has_family) const;

  /// What stands on a table was made to stand there, or lies on one of its sides, and then its planes are upright or
  /// level, but for few: doubts those that slant. Where nothing is known of a support, no plane does.
  /// \param planes the answer; those that are doubted go behind the others, and out where they are not even possible.
  void doubtSlanted(std::vector<SymmetryPlane>& planes) const;

private:
  /// Whether the sensor resolves the tolerance, or no tolerance that counts.
  bool isResolved() const;
  PlaneKind kindOf(const ReflectionPlane& plane, double confidence) const;

  const NormalizedCloud& cloud_;
  const PlaneMeasure& measure_;
  const DetectionOptions& options_;
};

/// Rank of a kind: 0 for symmetries, 1 for possible ones, 2 for others.
int rankOf(const SymmetryPlane& plane);

/// The order of answers: symmetries, then possible ones, both by falling confidence, then others by falling support.
bool isBetter(const SymmetryPlane& a, const SymmetryPlane& b);

/// True of symmetries and possible ones.
inline bool isDecided(const SymmetryPlane& plane) {
  return rankOf(plane) < 2;
}

}  // namespace pcl_symmetry
