#pragma once

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Refines planes, axes and centers on the mesh itself: the last step of a search whose points were sampled from a
/// mesh. Samples fix a plane to a share of their spacing, within which that of a slender or flat part can rotate far;
/// the mesh fixes it exactly. Share, deviation, residual and confidence of symmetries and possible ones become those of
/// the surface. Planes that coincide are reported once, in the order of Detection::planes, and those below
/// DetectionOptions::min_possible are dropped unless approximate ones are reported.
/// \param found by detectPlanes() on points of the mesh, without visibility; in the frame of the mesh. Its tolerance
/// decides.
/// \param options of that detection.
void refineOnMesh(const MeshSurface& mesh, Detection& found, const DetectionOptions& options = {});

}  // namespace pcl_symmetry
