#pragma once

#include <cstdint>
#include <vector>

#include "core/detection/turn_confidence.h"
#include "core/detection/turn_evidence.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// A line that may be an axis, and the order that it may have; 0: any angle.
struct AxisStart {
  Line3d line;
  int fold;
};

/// Lines that many normals of a scan meet or are parallel to: the best of all, and the best of small draws, so that a
/// base or a handle does not decide.
/// \param seed of the draws.
/// \param num_threads 0 = one per core.
std::vector<AxisStart> startsFromNormals(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads);

/// Common lines of planes at an angle of k pi / n.
/// \param planes normalized frame.
/// \param max_fold greatest n, >= 2.
std::vector<AxisStart> startsFromPlanes(const std::vector<ReflectionPlane>& planes, int max_fold);

/// Maxima of an axial transform with few bins and the free space of the scan.
std::vector<AxisStart> startsFromTransform(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads);

/// Axes of a scan: lines about which rotations by any angle, or by 2 pi / n, map what was seen onto itself, to unseen
/// space, and nowhere that the scanner saw to be empty. Beyond the paper, which leaves rotations to future work
/// (Section 6).
///
/// Lines come from the normals (a body of revolution), from pairs of planes, and from maxima of a coarse axial
/// transform. Each is moved to where the rotations fit best, then judged. A fold has to beat the rotations halfway
/// between its own; round is what no rotation contradicts.
/// \param evidence of a scan.
/// \param planes found so far, input frame.
/// \param evidence_of_all takes what was seen of each rotation, also of those that are not returned; may be null.
/// \return input frame, most confident first; no two along one line.
std::vector<SymmetryTurn> scanAxes(const TurnEvidence& evidence, const std::vector<SymmetryPlane>& planes,
                                   const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                                   std::vector<JudgedTurn>* evidence_of_all = nullptr);

/// The same for points of which no planes are known.
/// \param points 3 x N, finite, input units.
/// \param edt of these points.
/// \param axes lines that are tried first, input frame.
/// \param make_search as in detectPlanes().
/// \return nothing where the points hold no answer.
std::vector<SymmetryTurn> turnsOfScan(const PointsRef& points, const GaussianEdt& edt, const Visibility& visibility,
                                      const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                                      const MakeSearch& make_search = nullptr);

/// The axes of revolution of a scan, checked by rotations: those that throw a visible handle into empty space
/// are dropped, the others moved to where rotations fit best, and round bodies added that showed too few planes.
/// \param axes input frame, as from collectFamilies().
/// \param turns as from scanAxes().
std::vector<SymmetryAxis> withRoundTurns(const TurnEvidence& evidence, std::vector<SymmetryAxis> axes,
                                         const std::vector<SymmetryTurn>& turns, const DetectionOptions& options);

}  // namespace pcl_symmetry
