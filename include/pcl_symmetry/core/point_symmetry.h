#pragma once

#include <vector>

#include "pcl_symmetry/core/gaussian_edt_2d.h"
#include "pcl_symmetry/core/line_map.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// The transform mapped back from planes to points (Figures 1 and 2): for each point the greatest D of any plane
/// through it, over the directions of the map and all radii (in between by cubic interpolation). \param points 3 x N,
/// finite, input frame. \return one value per point; 0 where no plane of the map passes.
std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads = 0);

/// The same in the plane: the greatest D of any line through each point.
std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads = 0);

}  // namespace pcl_symmetry
