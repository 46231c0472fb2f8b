#pragma once

#include <vector>

namespace pcl_symmetry {

/// A range image while it is made: depths row by row, Visibility::kBackground where no ray met anything.
struct PartialImage {
  int width, height;           ///< >= 1
  std::vector<float>& depths;  ///< width * height
};

/// How far a ray is from the next one across the direction in which rays are dense: rings of a LiDAR scanner are many
/// pixels apart, whose rays in a ring are neighbors.
/// \return median over the pixels with a depth of the distance to the next such pixel in row or column, whichever is
/// larger, pixels; 0 where no pixel has neighbors in row and column.
double typicalGap(const PartialImage& image);

/// Closes the gaps between neighboring rays. An empty pixel between two filled ones, on the shortest of the four lines
/// through it along rows, columns and diagonals, gets the nearer of their depths: what lies between two rays counts as
/// seen to be free as far as both of them show it.
/// \param longest gap that is closed, pixels.
void bridgeGaps(PartialImage image, double longest);

}  // namespace pcl_symmetry
