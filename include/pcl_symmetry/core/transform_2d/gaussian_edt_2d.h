#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// 2 x N points of a contour or image, finite.
using Points2D = Eigen::Matrix2Xf;

/// Options of the Gaussian Euclidean distance transform in the plane. Zero means: choose from the data.
struct GaussianEdt2DOptions {
  int num_cells = 128;  ///< cells along each side, in [8, 4096]
  double sigma = 0.0;   ///< width, input units, >= 0; 0 = two cells, or the spacing of the points where that is more
  double radius = 0.0;  ///< radius of the disk to cover, input units, >= 0; 0 = a disk around the points
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< center of that disk; used only with radius > 0

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// f(x) = exp(-dist^2(x, points) / sigma^2) on a square of cells around points in the plane (Section 4.1): what
/// GaussianEdt is for points in space. f is 0 where it would be below 1.2e-3.
class GaussianEdt2D {
public:
  /// \param points 2 x N, finite, input units, N >= 1, not all equal unless options.radius is set.
  /// \throws std::invalid_argument for bad options, no points, points without extent, or non-finite values.
  explicit GaussianEdt2D(const Points2D& points, const GaussianEdt2DOptions& options = {});

  int numCells() const { return num_cells_; }
  double cellSize() const { return cell_size_; }  ///< input units
  double sigma() const { return sigma_; }         ///< input units
  /// The disk that the grid covers; a margin of two sigmas lies outside it.
  const Eigen::Vector2d& center() const { return center_; }
  double radius() const { return radius_; }
  /// Center of cell (0, 0), input frame.
  const Eigen::Vector2d& origin() const { return origin_; }

  /// num_cells^2 values of f in [0, 1] at the cell centers, x fastest.
  const std::vector<float>& values() const { return values_; }
  double sqNorm() const { return sq_norm_; }  ///< sum of f^2 over cells

private:
  int num_cells_ = 0;
  double cell_size_ = 0.0;
  double sigma_ = 0.0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
  double radius_ = 0.0;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::vector<float> values_;
  double sq_norm_ = 0.0;
};

}  // namespace pcl_symmetry
