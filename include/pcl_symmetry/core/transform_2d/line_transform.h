#pragma once

#include <vector>

#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/transform_2d/gaussian_edt_2d.h"
#include "pcl_symmetry/core/transform_2d/line_map.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The reflective symmetry of a planar shape with respect to every line (Sections 3 and 4.2).
///
/// In the plane the full sum over cells and lines is cheap, and no estimator is needed: at 128 cells and 128 x 128
/// lines a contour takes a tenth of a second. \return D at the bin centers.
LineMap lineTransform(const GaussianEdt2D& edt, const LineGrid& grid, const Eigen::Vector2d& center_of_mass,
                      int num_threads = 0);

/// D(f, gamma) at this very line.
double lineSymmetry(const GaussianEdt2D& edt, const ReflectionLine& line);

/// A line that is more of a symmetry than all lines near it.
struct LineMaximum {
  ReflectionLine line;  ///< canonical, input frame
  double value;         ///< D
};

/// Local maxima of the map that pass the paper's three thresholds (Section 4.4), each climbed to the maximum of D
/// itself, strongest first. A maximum on the seam is found once.
std::vector<LineMaximum> findLineMaxima(const GaussianEdt2D& edt, const LineMap& map,
                                        const LocalMaximaOptions& options = {});

/// The transform mapped back from lines to points: for each point the greatest D of any line through it.
/// \param points 2 x N, finite, input frame. \return one value per point; 0 where no line of the map passes.
std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads = 0);

}  // namespace pcl_symmetry
