/// Slices of a volume with its plane of symmetry, and where the two halves differ.
#pragma once

#include <optional>

#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/scalar_grid.h"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

/// Three slices through the middle of the body, seen along z, x and y of the input frame, with the line of the plane;
/// below them the same with the asymmetry f(x) - f(gamma x) in color: orange where a voxel is brighter than its
/// reflection, blue where it is darker.
/// \param plane nothing: only the upper row, without a line.
/// \param size edge of each slice, pixels.
RasterImage drawVolumeSlices(const ScalarGrid& volume, const VolumeLevels& levels,
                             const std::optional<ReflectionPlane>& plane, int size);

}  // namespace pcl_symmetry::apps
