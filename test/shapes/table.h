/// Boxes on a table, as a depth camera sees them.
#pragma once

#include "shapes/scans.h"

namespace pcl_symmetry::test {

/// The table is the first block; its top is z = 0. The second box hides half of the first from the viewpoint.
struct Table {
  BlockObject blocks;
  Scan scan;
  std::vector<int> ids;  ///< of each pixel, the block; -1 where the ray met none

  Table() : Table({{0.0, 0.1, 0.0}, {0.0, 0.0, 0.0}}) {}

  /// \param shifts of the two boxes.
  explicit Table(const std::vector<Eigen::Vector3d>& shifts)
      : blocks{{{{0.0, 0.0, -0.02}, {0.7, 0.7, 0.02}},
                {shifts[0] + Eigen::Vector3d(0.0, 0.1, 0.12), {0.2, 0.1, 0.12}},
                {shifts[1] + Eigen::Vector3d(0.15, -0.25, 0.1), {0.12, 0.08, 0.1}}},
               {}},
        scan(test::scan(blocks, {0.1, -1.6, 1.0}, 0.0, 320, 240)) {
    for (Eigen::Index i = 0; i < scan.pixels.cols(); ++i) ids.push_back(blockAt(scan.pixels.col(i).cast<double>()));
  }

  /// Indices of the pixels that show a block.
  std::vector<int> pixelsOf(int block) const {
    std::vector<int> found;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == block) found.push_back(static_cast<int>(i));
    return found;
  }

private:
  int blockAt(const Eigen::Vector3d& x) const {
    constexpr double kRounding = 1e-5;
    for (int k = static_cast<int>(blocks.blocks.size()) - 1; k >= 0 && x.allFinite(); --k) {
      const Block& block = blocks.blocks[static_cast<std::size_t>(k)];
      if (((x - block.center).cwiseAbs() - block.half).maxCoeff() < kRounding) return k;
    }
    return -1;
  }
};

}  // namespace pcl_symmetry::test
