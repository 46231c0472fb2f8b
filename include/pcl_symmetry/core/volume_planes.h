#pragma once

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/plane_types.h"
#include "pcl_symmetry/core/scalar_grid.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Planes of symmetry of a volume: maxima of the transform (Sections 4.1 to 4.3), each refined to where D itself is
/// greatest. A dense volume has no nearest points to iterate over, so Gauss-Newton steps of the three parameters of the
/// plane replace Iterative Symmetric Points: they minimize the sum of (f(x) - f(gamma x))^2, which is 2 |f|^2 - 2 f .
/// gamma(f), over the voxels whose reflection the volume shows. Pairs where f is as flat as its noise count little.
///
/// In the planes returned, `score` is D, `support` the correlation c (Pearson) of f with its reflection inside the
/// body, `seen` the share of the body whose reflection lies within the volume, and `residual` the root mean square of
/// f(x) - f(gamma x). No share of a surface is measured: `share` and its limits are NaN.
///
/// `confidence` is not a probability here but ((c - c0) / (1 - c0))^2, squared like the variance that a correlation
/// explains. c0 is the greater of two values: the upper quartile of c over planes through the center of mass in all
/// directions, without those near a maximum; and the mean c of the body translated as far as the plane moves its
/// points. The confidence falls if less than 0.6 of the body is seen, and, for planes other than the best, by the
/// square of the ratio of the two 1 - c, because 1 - c of the best plane is attributed to noise.
/// \param options num_cells, max_candidates, max_planes, min_confidence, min_possible, approximate, seed and
/// num_threads are used.
/// \param levels the range of intensities that is used.
/// \return symmetries and possible ones, and with `approximate` the other maxima, best first; if there are none,
/// Detection::best. A volume without an answer gives a reason.
/// \throws std::invalid_argument for bad options or levels.
Detection detectVolumePlanes(const ScalarGrid& volume, const DetectionOptions& options = {},
                             const VolumeLevels& levels = {});

}  // namespace pcl_symmetry
