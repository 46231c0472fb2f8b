#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/frame_evidence.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// Three perpendicular planes that may make the frame. Offsets are in cells from the middle of the grid.
struct FrameCandidate {
  Eigen::Matrix3f axes;     ///< columns: unit normals of the first, second and third plane
  Eigen::Vector3f offsets;  ///< offsets of these planes
  Eigen::Vector3f scores;   ///< scores of these planes
  /// For scans, the axis, 1 or 2, about which a rotation takes the first plane best to another symmetry; -1 for whole
  /// clouds. A body of revolution hides half of itself from each of its planes, but none of them conflicts with the
  /// visible surface. Therefore the score of the plane half-way between the first plane and the other plane about this
  /// axis is added to the value.
  int rotation_axis = -1;
  float half_way_offset = 0.0f;  ///< offset of that half-way plane
  double value = 0.0;            ///< criterion for frames: the greater, the better
};

/// The steps of the search for principal symmetry axes (Section 5.1). Departure from the paper: it picks the three
/// planes greedily by D; here the first plane is chosen with regard to the frame that it leads to.

/// Candidates for the first plane: maxima of the map, planes perpendicular to the principal axes of the points and
/// planes parallel to faces of the surface, each moved to the nearest maximum of quality().
std::vector<CellPlane> firstPlaneCandidates(const FrameEvidence& evidence, const SymmetryMap& map, int num_threads);

/// The candidates of the greatest quality, each direction once, best first.
std::vector<CellPlane> bestFirstPlanes(const FrameEvidence& evidence, const std::vector<CellPlane>& candidates);

/// Second and third planes of each first plane, on the completed cloud.
/// \return num_angles frames for each first plane, in order of the angle.
std::vector<FrameCandidate> framesAbout(const FrameEvidence& evidence, const std::vector<CellPlane>& first_planes,
                                        int num_threads);

/// The frames whose value is a local maximum over the angle about their first axis, best first; at least one.
/// \param rotated result of framesAbout() for at least one first plane.
std::vector<FrameCandidate> frameMaxima(const std::vector<FrameCandidate>& rotated);

/// The frame of given axes, each plane at its best offset, in the order of refinedFrames().
/// \param axes orthonormal columns: normals of the planes, the first plane first.
FrameCandidate frameOfAxes(const FrameEvidence& evidence, const Eigen::Matrix3f& axes);

/// Moves each frame to the nearest maximum of its value, all three planes together. Then orders the second and third
/// axis by score, or where scores tie by the spread of the points.
std::vector<FrameCandidate> refinedFrames(const FrameEvidence& evidence, std::vector<FrameCandidate> frames,
                                          int num_threads);

}  // namespace pcl_symmetry
