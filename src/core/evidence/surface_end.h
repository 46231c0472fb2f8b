#pragma once

#include "core/evidence/outermost_points.h"

namespace pcl_symmetry {

/// How well the end of a cloud explains that a piece of its reflection has no counterpart.
///
/// Not in the paper. Where a piece of an object was cut off, the reflection goes on beyond a plane, and the surface
/// runs into that plane: its normals lie along it. A part that an object has on one side alone has its reflection
/// beyond the surface, too, but there the surface closes: its normals stand on the plane. No open border is needed, so
/// that parts as thin as the spacing, whose borders are not seen, and parts without any edge to what is matched are
/// told as well.
/// \param cloud the N points of the cloud.
/// \param normals 3 x N, unit, of arbitrary sign.
/// \param piece reflections of neighbouring points without counterpart.
/// \param spacing median distance of the points.
/// \return in [0, 1]: 1 where the cloud was cut off before the piece, 0 where a counterpart should be there.
float beyondEnd(const OutermostPoints& cloud, const Points& normals, const OutermostPoints& piece, double spacing);

}  // namespace pcl_symmetry
