#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct VolumeFunction;

/// Options of the Gaussian Euclidean distance transform. Zero means: choose from the data.
struct GaussianEdtOptions {
  int num_cells = 64;  ///< cells along each side, in [8, 512]
  /// Width of the Gaussian, input units, >= 0; 0 = two cells, or the spacing of the points if that is more.
  double sigma = 0.0;
  int num_threads = 0;  ///< >= 0; 0 = one per core
  double radius = 0.0;  ///< radius of the ball to cover, input units, >= 0; 0 = the bounding ball of the points
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< center of that ball, input frame; used only with radius > 0

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The Gaussian Euclidean distance transform of points, f(x) = exp(-dist^2(x, points) / sigma^2), on a cube of cells
/// (Section 4.1).
///
/// Distances are exact: they are measured from the points themselves, not from occupied cells. Where f would be less
/// than 1.2e-3 it is 0. Clouds with many points to a cell are first thinned to one point in each 1/64 of a cell, which
/// adds at most 0.43 cells to a distance and lowers the sum of f by less than 1 % (at 32 cells a side and more).
class GaussianEdt {
public:
  /// \param points 3 x N, finite, input units, N >= 1, not all equal unless options.radius is set.
  /// \throws std::invalid_argument for bad options, no point, points without extent, or a value that is not finite.
  explicit GaussianEdt(const PointsRef& points, const GaussianEdtOptions& options = {});

  /// Resamples the function of a volume on the cells (Section 4.2); all estimators accept it in place of a distance
  /// transform.
  /// \param options if radius is 0, the bounding ball of the body is covered. sigma is not used: the margin is that of
  /// a sigma of two cells.
  /// \throws std::invalid_argument for bad options.
  explicit GaussianEdt(const VolumeFunction& volume, const GaussianEdtOptions& options = {});

  int numCells() const { return num_cells_; }     ///< cells along each side of the cube
  double cellSize() const { return cell_size_; }  ///< input units
  double sigma() const { return sigma_; }         ///< input units
  /// Center of the ball that the grid covers, input frame. A margin of two sigmas surrounds it.
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }  ///< radius of that ball, input units
  /// \return center of cell (0, 0, 0), input frame.
  const Eigen::Vector3d& origin() const { return origin_; }

  /// \return num_cells^3 values of f in [0, 1] at the cell centers, x fastest.
  const std::vector<float>& values() const { return values_; }
  /// The cells [begin, end) of a row along x.
  struct Range {
    int begin;  ///< index of the first cell
    int end;    ///< index after the last cell
  };
  /// \return one range for each of the num_cells^2 rows, y fastest: f is 0 in all other cells of the row.
  const std::vector<Range>& filledRanges() const { return filled_; }
  /// \param index index of a cell, as in values().
  /// \return center of the cell, input frame.
  Eigen::Vector3d cellCenter(std::size_t index) const;

  /// Greatest distance in cells from a point that was left out, as many were near, to one that f shows.
  double thinning() const { return thinning_; }
  double sum() const { return sum_; }         ///< sum of f over the cells
  double sqNorm() const { return sq_norm_; }  ///< |f|^2, the sum of f^2 over the cells

  /// f between the cell centers: trilinear interpolation of sharpened() values, so that the mean over a cell is right.
  /// \param x input frame.
  /// \return f(x), about [0, 1]; 0 outside the grid.
  double operator()(const Eigen::Vector3d& x) const { return atCell((x - origin_) / cell_size_); }

  /// The same function of a position in cells.
  /// \param p cells from the center of cell (0, 0, 0).
  double atCell(const Eigen::Vector3d& p) const {
    if (!((p.array() >= 0.0).all() && (p.array() < num_cells_ - 1.0).all())) return 0.0;
    const Eigen::Vector3i c = p.cast<int>();
    const Eigen::Vector3d t = p - c.cast<double>();
    const std::size_t n = num_cells_;
    const float* f = interpolation_.data() + (static_cast<std::size_t>(c.z()) * n + c.y()) * n + c.x();
    const auto row = [&](std::size_t offset) { return f[offset] + t.x() * (f[offset + 1] - f[offset]); };
    const double near = row(0) + t.y() * (row(n) - row(0));
    const double far = row(n * n) + t.y() * (row(n * n + n) - row(n * n));
    return near + t.z() * (far - near);
  }

  /// \return sharpened(1 / 12), between which this function interpolates.
  const std::vector<float>& interpolation() const { return interpolation_; }

  /// Values that compensate for the blur of look-ups: f - c h^2 Laplace(f), at least 0, with h the size of a cell.
  /// Look-ups of f itself would understate D of a perfect symmetry by 2 to 4 per cent.
  /// \param c 1/24 for look-ups of the nearest cell, 1/12 for trilinear interpolation.
  /// \param num_threads 0 = one per core.
  /// \return one value per cell, x fastest.
  std::vector<float> sharpened(double c, int num_threads = 0) const;

private:
  /// Chooses the cells. \param sigma 0 = two cells.
  void cover(const BoundingBall& ball, int num_cells, double sigma);
  void computeValues(const PointsRef& points, int num_threads);
  /// Sums the values, and prepares look-ups between them.
  void finish(int num_threads);

  int num_cells_ = 0;
  double cell_size_ = 0.0;
  double sigma_ = 0.0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<float> values_;
  std::vector<Range> filled_;
  std::vector<float> interpolation_;
  double thinning_ = 0.0;
  double sum_ = 0.0;
  double sq_norm_ = 0.0;
};

}  // namespace pcl_symmetry
