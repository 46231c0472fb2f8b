#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry {

/// A side of the picture of a camera, at which the object was cut off: no ray passed where normal . p > offset.
struct FrameSide {
  Eigen::Vector2d normal;  ///< unit, out of the picture
  double offset;           ///< of the line, units of the positions
};

/// Finds the sides of the picture that cut the object, from the points alone.
///
/// Not in the paper. Pixels lie in rows and columns, and so do the positions of the points of a scan. Where the picture
/// ends, its last row is as long as those before it; where the object ends, rows become shorter. A straight edge of the
/// object that lies along a row looks like a side of the picture: beyond it nothing is said then, which loses evidence
/// but gives none.
/// \param positions of points in the picture plane at depth one.
/// \return at most four sides; none where the positions are in no grid, as those of a part of the points drawn at random.
std::vector<FrameSide> frameSides(const std::vector<Eigen::Array2d>& positions);

}  // namespace pcl_symmetry
