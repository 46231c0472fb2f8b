#pragma once

#include <vector>

#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/transform_2d/gaussian_edt_2d.h"
#include "pcl_symmetry/core/transform_2d/line_map.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The reflective symmetry of a planar shape with respect to every line (Sections 3 and 4.2).
///
/// In the plane the full sum over cells and lines is cheap, so that no estimator is needed: a contour at 128 cells a
/// side and 128 x 128 lines takes a tenth of a second.
/// \param edt the function f.
/// \param grid the lines, in the frame of the EDT.
/// \param center_of_mass mean of the points, in the same frame.
/// \param num_threads 0 = one per core; the map does not depend on it.
/// \return D at the bin centers.
LineMap lineTransform(const GaussianEdt2D& edt, const LineGrid& grid, const Eigen::Vector2d& center_of_mass,
                      int num_threads = 0);

/// \param line in the frame of the EDT.
/// \return D(f, gamma) at exactly this line.
double lineSymmetry(const GaussianEdt2D& edt, const ReflectionLine& line);

/// A line with a greater D than all lines near it.
struct LineMaximum {
  ReflectionLine line;  ///< canonical, input frame
  double value;         ///< D
};

/// Local maxima of D: the maxima of the map that pass the three thresholds of Section 4.4, each refined to the maximum
/// of D itself. A maximum on the seam is found once.
/// \param edt the function that the map was made from.
/// \return maxima by falling D.
/// \throws std::invalid_argument for bad options.
std::vector<LineMaximum> findLineMaxima(const GaussianEdt2D& edt, const LineMap& map,
                                        const LocalMaximaOptions& options = {});

/// The transform mapped back from lines to points (Figures 1 and 2): for each point the greatest D of any line through
/// it.
/// \param points 2 x N, finite, input frame.
/// \param num_threads 0 = one per core; the values do not depend on it.
/// \return one value per point, >= 0; 0 where no line of the map passes.
std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads = 0);

}  // namespace pcl_symmetry
