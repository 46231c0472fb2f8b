#pragma once

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Moves the planes of a detection to where they map the mesh itself onto itself, and its axes and centers: the last
/// step of a search whose points were spread over a mesh. Samples know a plane to a share of their spacing, and a
/// slender or flat part turns far within that; the mesh knows it exactly. Share, deviation, residual and confidence of
/// symmetries and possible ones become those of the surface. Planes that then are one are reported once, and those
/// below DetectionOptions::min_possible are dropped unless approximate ones are reported.
/// \param found by detectPlanes() on points of the mesh, without visibility; in the frame of the mesh. Its tolerance
/// decides.
/// \param options of that detection.
void refineOnMesh(const MeshSurface& mesh, Detection& found, const DetectionOptions& options = {});

}  // namespace pcl_symmetry
