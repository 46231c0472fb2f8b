#pragma once

#include <optional>
#include <vector>

#include "core/rotation/rotation_evidence.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/plane_types.h"

namespace pcl_symmetry {

/// Lines about which a scan may be round, from its normals, moved to where rotations by small angles fit best.
std::vector<Line3d> linesOfNormals(const RotationEvidence& evidence, const DetectionOptions& options);

/// Axes of a scan: lines about which rotations by any angle, or by 2 pi / n, map the visible surface onto itself or
/// into unseen space, but not into free space. Not in the paper, which leaves rotations to future work (Section 6).
///
/// Lines come from the normals (for a body of revolution), from pairs of planes, and from maxima of a coarse axial
/// transform. Each is moved to where the rotations fit best, then judged. A fold is accepted only if the rotations
/// halfway between its own fail more; a line that no rotation contradicts is an axis of revolution.
/// \param evidence evidence of a scan.
/// \param lines lines from linesOfNormals().
/// \param planes planes found so far, input frame.
/// \param evidence_of_all filled with the evidence of all rotations, including those that are not returned; may be
/// null.
/// \return input frame, most confident first; no two along one line.
std::vector<SymmetryRotation> scanAxes(const RotationEvidence& evidence, const std::vector<Line3d>& lines,
                                       const std::vector<SymmetryPlane>& planes, const std::vector<SymmetryAxis>& axes,
                                       const DetectionOptions& options,
                                       std::vector<JudgedRotation>* evidence_of_all = nullptr);

/// The axis of a body that is round except for a part, such as a mug with its handle, and that part.
struct NearlyRound {
  Line3d axis;                ///< normalized frame
  std::vector<int> off_body;  ///< as RotationEvidence::samplesOffBody()
};

/// \param lines from linesOfNormals().
/// \return nothing if a scan shows no such body.
std::optional<NearlyRound> nearlyRound(const RotationEvidence& evidence, const std::vector<Line3d>& lines);

/// The center of a ball seen from one side: rotations by any angle about any line through it map the visible surface
/// onto itself or into unseen space.
std::optional<SymmetryCenter> centerOfScan(const RotationEvidence& evidence, const DetectionOptions& options);

/// The center of a ball, or the axes of a scan whose planes are not known.
/// \param points 3 x N, finite, input units.
/// \param edt distance transform of these points.
/// \param axes lines that are tried first, input frame.
/// \param make_search as in detectPlanes().
/// \return centers and rotations; none if the points cannot be analyzed.
Detection rotationsOfScan(const PointsRef& points, const GaussianEdt& edt, const Visibility& visibility,
                          const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                          const MakeSearch& make_search = nullptr);

/// The axes of revolution of a scan, checked by rotations: axes that map a visible handle into free space are dropped,
/// the others moved to where rotations fit best, and axes of round bodies with too few visible planes added.
/// \param axes input frame, as from findFamilies().
/// \param rotations as from scanAxes().
std::vector<SymmetryAxis> withRoundAxes(const RotationEvidence& evidence, std::vector<SymmetryAxis> axes,
                                        const std::vector<SymmetryRotation>& rotations,
                                        const DetectionOptions& options);

}  // namespace pcl_symmetry
