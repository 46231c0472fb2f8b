#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/frame/frame_search.h"

namespace pcl_symmetry {

/// The principal symmetry axes (PSA) of the canonical frame (Section 5.1): the normals of the three planes, exactly
/// orthonormal and right-handed. Signs come from the third central moments of the points.
/// \param axes columns: unit normals, perpendicular to within rounding.
Eigen::Matrix3d principalSymmetryAxes(const PointsRef& points, const Eigen::Matrix3f& axes);

/// The center of symmetry (COS): where the three planes meet.
///
/// Departure from the paper: along a direction with little symmetry, the maximum of the profile is a matter of chance.
/// The plane passes there only if it stands high above all other scores, as for the plane across the box of a mailbox;
/// elsewhere the offset is the mean over all offsets, weighted by score and by closeness to the middle of the extent of
/// the points. The nearer the maximum is to that mean, the less height it needs. All profiles of a scan count as flat.
/// \return input frame.
Eigen::Vector3d centerOfSymmetry(const FrameEvidence& evidence, const FrameCandidate& frame);

/// The center where several frames are nearly as good: the mean of their centers, weighted by their values. Frames of a
/// symmetric shape share one center; without symmetry, chance and visibility decide which frame is best.
/// \param frames best first, at least one.
Eigen::Vector3d meanCenter(const std::vector<Eigen::Vector3d>& centers, const std::vector<FrameCandidate>& frames);

/// The axis of revolution among the axes of a frame: planes at all angles about it have equal scores.
/// \return column of the axis; -1 = none, 3 = two axes are axes of revolution: a sphere.
int revolutionAxis(const FrameEvidence& evidence, const FrameCandidate& frame);

/// The pose that takes the center to the origin and the axes to x, y and z.
/// \param axes orthonormal columns.
Eigen::Isometry3d canonicalPose(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center);

/// Adds the poses of a frame, with all four choices of signs that are rotations, to equally good ones, because planes
/// have no sign. Poses whose axes differ by less than 5 degrees count as one.
/// \param axes orthonormal columns, right-handed.
/// \param[in,out] poses T_canonical_input of each frame.
void addWithSigns(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center, std::vector<Eigen::Isometry3d>& poses);

/// The same for a frame, in all orders of its axes in which none of its planes scores less than the one it replaces.
/// \param scores scores of the best frame.
void addTied(const FrameCandidate& frame, const Eigen::Vector3f& scores, const Eigen::Vector3d& center,
             std::vector<Eigen::Isometry3d>& poses);

/// Whether a frame is one of \p axes rotated about its axis of revolution: these are all equally good and are not
/// listed.
/// \param revolution_axis as in SymmetryFrame.
bool isRotatedAboutRevolution(const Eigen::Matrix3f& axes, int revolution_axis, const Eigen::Matrix3f& frame);

/// \return the axis of a frame that is certainly the axis of a rotation; -1 = none.
int axisAlong(const SymmetryRotation& rotation, const SymmetryFrame& frame);

/// Moves the center and axes of a frame to the axes of its rotations and to the planes of symmetry that detectPlanes()
/// decides; axes whose perpendicular plane is no symmetry follow the others.
void refineOnPoints(const PointsRef& points, const Visibility* visibility, const FrameOptions& options,
                    SymmetryFrame& frame);

}  // namespace pcl_symmetry
