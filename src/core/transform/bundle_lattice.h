#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/plane_grid.h"

namespace pcl_symmetry {

constexpr int kRowLanes = 8;    ///< lines of a bundle through cells of the same row, which are looked up by one load
constexpr int kBundleRows = 2;  ///< rows whose lanes make a bundle
constexpr int kBundleLanes = kBundleRows * kRowLanes;
constexpr int kNumSlabs = 13;  ///< pairs of the 26 neighbors of a cell

/// Parallel lines of equally spaced points, through kRowLanes cells of each of some rows: point l of the first one of
/// row r is start[r] + l * step, in fixed-point cells, for l in [first, last). What lies beyond the cube is 0.
struct Bundle {
  std::int32_t start[kBundleRows][3];
  std::int32_t step[3];
  int first, last;
};

/// Slabs around the cells in which f is not 0, along the directions to the neighbors of a cell: low <= axes . p <= high
/// for all p in one of them, in cells from the center of cell (0, 0, 0). Most shapes fill a small part of their ball.
struct SlabsOfCells {
  explicit SlabsOfCells(const GaussianEdt& edt);

  Eigen::Matrix<float, kNumSlabs, 3> axes;
  Eigen::Matrix<float, kNumSlabs, 1> low, high;
};

/// The lattice that the EDT is resampled on, and the bins of r, common to all directions. Lengths are in cells;
/// positions are relative to the middle of the EDT's cube, beyond whose inscribed ball f is taken as 0.
struct BundleLattice {
  BundleLattice(const GaussianEdt& edt, const PlaneGrid& grid, double spacing_in_sigmas);

  /// \return from the middle of a row of a bundle to its first and last line.
  double half() const { return 0.5 * (kRowLanes - 1) * step; }

  SlabsOfCells slabs;
  double middle;           ///< coordinate of the middle in cells from the first cell center
  double clip;             ///< radius of the ball beyond which f is taken as 0
  Eigen::Vector3d center;  ///< of the grid of planes
  double grid_offset;      ///< of the first bin from the center of the grid
  double radius_step;
  double spacing;  ///< between parallel lines
  int step;        ///< between the lines of a bundle, along an axis of the cells
  /// Points at t0 + l * along have the planes between them at t0 + (a + b) * along / 2: every refine-th one is a bin.
  int refine;
  double along;       ///< between the points of a line
  double most_ahead;  ///< from the middle of a row to its first and last line, along the normal
  int num_along;      ///< points of a line
};

/// The bundles of one direction: lines along the normal n through every step-th cell of rows of cells. Rows lie along
/// the axis e that is the farthest from n, at equal distances along v, which is across both. Vectors have e first.
///
/// Point l of the middle of a row of a bundle has the height t = t0 + l * along, and lies at x e + b v + tau n with
/// tau = t - x n.x.
class BundlesOfDirection {
public:
  BundlesOfDirection(const BundleLattice& lattice, const Eigen::Vector3d& normal);

  int axis() const { return axis_; }  ///< of the rows
  /// \return bins from t0 to the first one, times -1.
  double numSkipped() const { return num_skipped_; }
  double between() const { return between_; }  ///< rows
  /// \return height of a line above the one before in its row, in cells.
  double ahead() const { return lattice_.step * n_.x(); }
  /// \return volume that each point represents, in cells.
  double volume() const { return lattice_.along * between_ * lattice_.step * across_; }
  int numRows() const;  ///< on each side of the middle

  /// Where a row of the lattice lies.
  struct Row {
    double b;
    double shift;  ///< along it
  };
  /// Adds the bundles of kBundleRows rows, each cut to where it can meet what is not 0. Those of which nothing is left
  /// are not added.
  void addBundles(const Row* rows, std::vector<Bundle>& bundles) const;

private:
  void setSlabs();
  void cutRow(const Row& row, const float* x, float* first, float* last) const;

  const BundleLattice& lattice_;
  int axis_ = 0;
  Eigen::Vector3d n_, v_;
  double across_;       ///< distance of lines whose feet are one cell apart on a row
  double between_;      ///< rows
  double num_skipped_;  ///< bins from t0 to the first one, times -1
  double t0_;           ///< height of the first points of all bundles
  std::int32_t step_[3];
  /// A bundle meets slab k for tau between entry - moved and exit - moved, with moved = b of_b + x of_x.
  float entry_[kNumSlabs], exit_[kNumSlabs], of_b_[kNumSlabs], of_x_[kNumSlabs];
};

}  // namespace pcl_symmetry
