#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt_2d.h"
#include "pcl_symmetry/core/local_maxima.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A line of reflection in the plane, { x : n.x = r } with unit normal n = (cos theta, sin theta) and signed offset r:
/// the planar case of ReflectionPlane (Section 4.2).
///
/// (theta, r) and (theta + pi, -r) are the same line: compare canonical forms, or use angleTo().
class ReflectionLine {
public:
  /// The line x = 0.
  ReflectionLine() = default;

  /// \param theta angle of the normal from the x axis, radians.
  /// \param offset n.x for points x of the line, input units.
  /// \throws std::invalid_argument for a value that is not finite.
  ReflectionLine(double theta, double offset);

  double theta() const { return theta_; }                    ///< of the normal, radians in [0, pi)
  double offset() const { return offset_; }                  ///< r, input units
  const Eigen::Vector2d& normal() const { return normal_; }  ///< unit, input frame

  /// \return n.x - r, input units.
  double signedDistance(const Eigen::Vector2d& x) const { return normal_.dot(x) - offset_; }

  /// \return the reflected point, x - 2 (n.x - r) n.
  Eigen::Vector2d reflect(const Eigen::Vector2d& x) const { return x - 2.0 * signedDistance(x) * normal_; }

  /// \return the same line with theta in [0, pi).
  ReflectionLine canonical() const;

  /// \return angle between the two lines, in [0, pi/2] radians.
  double angleTo(const ReflectionLine& other) const;

private:
  double theta_ = 0.0;
  double offset_ = 0.0;
  Eigen::Vector2d normal_ = Eigen::Vector2d::UnitX();
};

/// The discrete space of lines (Section 4.2): theta in [0, pi) and r in [-radius, radius] about a center, each cut into
/// equal bins. Bin (t, k) has its center at theta = (t + 1/2) dtheta, r = (k + 1/2) dr - radius.
///
/// Seam: past theta = pi lies (theta - pi, -r).
class LineGrid {
public:
  /// Indices of a cell of the grid.
  struct Bin {
    int theta;   ///< in [0, numTheta())
    int radius;  ///< in [0, numRadius())
  };

  LineGrid() = default;

  /// \param num_theta,num_radius number of bins, each in [1, 4096].
  /// \param center finite, input frame; r is measured from it.
  /// \param radius finite and > 0, input units.
  /// \throws std::invalid_argument naming field, value and rule.
  LineGrid(int num_theta, int num_radius, const Eigen::Vector2d& center, double radius);

  int numTheta() const { return num_theta_; }                                              ///< bins of theta
  int numRadius() const { return num_radius_; }                                            ///< bins of r
  std::size_t size() const { return static_cast<std::size_t>(num_theta_) * num_radius_; }  ///< all bins
  const Eigen::Vector2d& center() const { return center_; }  ///< that r is measured from, input frame
  double radius() const { return radius_; }                  ///< greatest |r|, input units

  double thetaStep() const;   ///< radians
  double radiusStep() const;  ///< input units

  /// \return theta * num_radius + radius: bins of one direction lie side by side.
  std::size_t index(const Bin& bin) const { return static_cast<std::size_t>(bin.theta) * num_radius_ + bin.radius; }
  /// \return the bin of an index; the inverse of index().
  Bin bin(std::size_t index) const;

  double theta(int t) const { return (t + 0.5) * thetaStep(); }  ///< at the bin center, radians
  /// \return r at the bin center: signed distance of the line from the grid's center, input units.
  double offset(int k) const { return (k + 0.5) * radiusStep() - radius_; }

  /// \return the line at the bin center, input frame.
  ReflectionLine line(const Bin& bin) const;

  /// \param dt,dk steps, dt in {-1, 0, 1}.
  /// \return the bin at (t + dt, k + dk), across the seam; none beyond the ends of r.
  std::optional<Bin> step(const Bin& bin, int dt, int dk) const;

private:
  int num_theta_ = 0;
  int num_radius_ = 0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
  double radius_ = 0.0;
};

/// The transform of a planar shape: D(f, gamma) = f . gamma(f) / |f|^2 (Equation 2) for every bin of lines.
struct LineMap {
  LineGrid grid;              ///< the lines of the values
  std::vector<float> values;  ///< grid.size() values of D, about [0, 1]; 1 for a perfect symmetry
  double sigma = 0.0;         ///< width of the distance transform that the map was made from, input units
  /// Mean of the points, input frame. The threshold 1 - r / R of Section 4.4 measures r from it.
  Eigen::Vector2d center_of_mass = Eigen::Vector2d::Zero();

  /// \return D at a bin.
  float operator[](std::size_t index) const { return values[index]; }
  bool empty() const { return values.empty(); }  ///< no transform was computed

  /// \return index of the bin with the greatest value; 0 for an empty map.
  std::size_t strongest() const { return std::max_element(values.begin(), values.end()) - values.begin(); }
};

/// The reflective symmetry of a planar shape with respect to every line (Sections 3 and 4.2).
///
/// In the plane the full sum over cells and lines is cheap, so that no estimator is needed.
/// \param edt the function f.
/// \param grid the lines, in the frame of the EDT.
/// \param center_of_mass mean of the points, in the same frame.
/// \param num_threads 0 = one per core; the map does not depend on it.
/// \return D at the bin centers.
LineMap lineTransform(const GaussianEdt2D& edt, const LineGrid& grid, const Eigen::Vector2d& center_of_mass,
                      int num_threads = 0);

/// A line with a greater D than all lines near it.
struct LineMaximum {
  ReflectionLine line;  ///< canonical, input frame
  double value;         ///< D
};

/// Local maxima of D: the maxima of the map that pass the three thresholds of Section 4.4, each refined to the maximum
/// of D itself. A maximum on the seam is found once.
/// \param edt the function that the map was made from.
/// \param num_threads 0 = one per core; the maxima do not depend on it.
/// \return maxima by falling D.
/// \throws std::invalid_argument for bad options.
std::vector<LineMaximum> findLineMaxima(const GaussianEdt2D& edt, const LineMap& map,
                                        const LocalMaximaOptions& options = {}, int num_threads = 0);

/// The transform mapped back from lines to points (Figures 1 and 2): for each point the greatest D of any line through
/// it.
/// \param points 2 x N, finite, input frame.
/// \param num_threads 0 = one per core; the values do not depend on it.
/// \return one value per point, >= 0; 0 where no line of the map passes.
std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads = 0);

}  // namespace pcl_symmetry
