#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame/frame_search.h"

namespace pcl_symmetry {

/// Frames as people put a shape that has one plane of symmetry: turned about its normal until the shape is level. Not
/// in the paper, whose second axis is that of the greatest D even where no second plane is a symmetry.

/// Frames turned about their first axis to the smallest box around the outline, to its longest contact, to the faces of
/// the surface, and to the principal axes of the outline.
/// \param first unit, the first axis.
/// \param tie scores that differ by no more than this are equal.
std::vector<FrameCandidate> leveledFrames(const FrameEvidence& evidence, const Eigen::Vector3f& first, double tie);

/// Puts the best frame, turned to the faces of the surface, before all others where its value is nearly as great and
/// the shape then stands on more of its outline.
/// \param frames best first, at least one.
std::vector<FrameCandidate> leveledFirst(const FrameEvidence& evidence, std::vector<FrameCandidate> frames, double tie);

}  // namespace pcl_symmetry
