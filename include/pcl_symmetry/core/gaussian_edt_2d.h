#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// 2 x N points of a contour or picture, one a column, finite.
using Points2D = Eigen::Matrix2Xf;

/// Flat points as points of their plane.
struct Sheet {
  Eigen::Isometry3d T_input_sheet = Eigen::Isometry3d::Identity();  ///< takes (x, y, 0) to the input frame
  Points2D points;                                                  ///< 2 x N, input units
};

/// Projects points to the plane in which they lie.
/// \param points 3 x N, finite, N >= 1.
/// \return the points in that plane. If all z are equal to a millionth of the extent, x and y are kept. Otherwise they
/// are coordinates along the first two principal axes, from the center of mass.
Sheet flattened(const PointsRef& points);

/// Options of the Gaussian Euclidean distance transform in the plane. Zero means: choose from the data.
struct GaussianEdt2DOptions {
  int num_cells = 128;  ///< cells along each side, in [8, 4096]
  double sigma = 0.0;   ///< width, input units, >= 0; 0 = two cells, or the spacing of the points if that is more
  double radius = 0.0;  ///< radius of the disk to cover, input units, >= 0; 0 = a disk around the points
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< center of that disk, input frame; used only with radius > 0

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The planar case of GaussianEdt: f(x) = exp(-dist^2(x, points) / sigma^2) on a square of cells around points in the
/// plane (Section 4.1), 0 where that would be less than 1.2e-3.
class GaussianEdt2D {
public:
  /// \param points 2 x N, finite, input units, N >= 1, not all equal unless options.radius is set.
  /// \throws std::invalid_argument for bad options, no point, points without extent, or a value that is not finite.
  explicit GaussianEdt2D(const Points2D& points, const GaussianEdt2DOptions& options = {});

  int numCells() const { return num_cells_; }     ///< cells along each side of the square
  double cellSize() const { return cell_size_; }  ///< input units
  double sigma() const { return sigma_; }         ///< input units
  /// Center of the disk that the grid covers, input frame. A margin of two sigmas surrounds it.
  const Eigen::Vector2d& center() const { return center_; }
  double radius() const { return radius_; }  ///< of that disk, input units
  /// \return center of cell (0, 0), input frame.
  const Eigen::Vector2d& origin() const { return origin_; }

  /// \return num_cells^2 values of f in [0, 1] at the cell centers, x fastest.
  const std::vector<float>& values() const { return values_; }
  double sqNorm() const { return sq_norm_; }  ///< |f|^2, the sum of f^2 over the cells

private:
  void computeValues(const Points2D& points);

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
