#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Squared distances of the cells of a cube from the nearest of some points, exact up to a reach (Section 4.1).
///
/// A cube of cells is compared with the points that may be nearest to one of its cells, its eight parts with those of
/// them that may still be: near a surface these are forty, whatever the reach.
class CellDistances {
public:
  /// \param points 3 x N, in cells from the center of cell (0, 0, 0).
  /// \param num_cells along each side of the cube.
  /// \param reach beyond which distances do not matter, cells, > 0.
  CellDistances(const Points& points, int num_cells, float reach);

  /// The cube is filled row by row of blocks, in any order.
  int numRows() const { return num_blocks_ * num_blocks_; }

  /// \param row in [0, numRows()).
  /// \param[out] sq_distances num_cells^3 values, x fastest: the squared distance from the nearest point in cells, at
  /// most reach^2. Those of the row are written.
  void fill(int row, float* sq_distances) const;

private:
  struct Candidates;
  struct Block {
    int x, y, z;  ///< first cell
  };

  int bin(float coordinate) const;
  void gather(const Block& block, Candidates& found) const;
  void fillBlock(const Block& block, Candidates& found, Candidates& near, float* sq_distances) const;
  void fillPart(const Block& part, const Candidates& near, float* sq_distances) const;

  int num_cells_, num_blocks_, num_bins_;
  float sq_reach_, reach_;
  std::vector<int> begin_;        ///< first point of each bin, x fastest
  std::vector<float> x_, y_, z_;  ///< of the points, bin by bin
};

}  // namespace pcl_symmetry
