/// What pcl_symmetry_bop tells of rotations that are no symmetries: by how much they fail, and where.
#pragma once

#include <string>

#include "bop/surface_evidence.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// Rejected candidates that are told of, those that fail least. chosen: a screen holds them; the rest fail widely.
constexpr int kMostRejections = 3;

/// Prints the groups at half and twice the tolerance, and the rejected rotations with the least failure.
/// \param digits significant ones of lengths.
void printRejections(const ObjectSymmetries& symmetries, int digits);

/// Writes PREFIX_rejected_1.ply and so on, each the surface with what a rejected rotation maps off it: red beyond the
/// tolerance, purple beyond ten; grey is mapped onto the surface.
/// \param surface in the frame of the symmetries.
/// \param shift that is added to the points.
/// \throws InputError where a file cannot be written.
void writeRejections(const std::string& prefix, const ObjectSymmetries& symmetries, const SurfaceEvidence& surface,
                     const Eigen::Vector3d& shift);

}  // namespace pcl_symmetry::apps
