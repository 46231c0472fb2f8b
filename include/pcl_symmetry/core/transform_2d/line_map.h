#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/transform_2d/reflection_line.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The discrete space of lines (Section 4.2): theta in [0, pi), r in [-radius, radius] about a center, cut into equal
/// bins; bin (t, k) has its center at ((t + 1/2) dtheta, (k + 1/2) dr - radius).
///
/// One seam: past theta = pi lies (theta - pi, -r).
class LineGrid {
public:
  struct Bin {
    int theta;
    int radius;
  };

  LineGrid() = default;

  /// \param num_theta,num_radius bins, each in [1, 4096]. \param center,radius in input units; radius > 0 and finite.
  /// \throws std::invalid_argument naming the field.
  LineGrid(int num_theta, int num_radius, const Eigen::Vector2d& center, double radius);

  int numTheta() const { return num_theta_; }
  int numRadius() const { return num_radius_; }
  std::size_t size() const { return static_cast<std::size_t>(num_theta_) * num_radius_; }
  const Eigen::Vector2d& center() const { return center_; }
  double radius() const { return radius_; }

  double thetaStep() const;   ///< radians
  double radiusStep() const;  ///< input units

  /// Bins of one direction lie side by side: index = theta * num_radius + radius.
  std::size_t index(const Bin& bin) const { return static_cast<std::size_t>(bin.theta) * num_radius_ + bin.radius; }
  Bin bin(std::size_t index) const;

  double theta(int t) const { return (t + 0.5) * thetaStep(); }
  /// Offset of the bin center from the grid's center, input units.
  double offset(int k) const { return (k + 0.5) * radiusStep() - radius_; }

  /// The line at the bin center, in the input frame.
  ReflectionLine line(const Bin& bin) const;

  /// The bin that holds the line; none where the line passes the center at more than radius().
  std::optional<Bin> find(const ReflectionLine& line) const;

  /// The bin at (t + dt, k + dk) with dt in {-1, 0, 1}, led across the seam; none beyond the ends of r.
  std::optional<Bin> step(const Bin& bin, int dt, int dk) const;

private:
  int num_theta_ = 0;
  int num_radius_ = 0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
  double radius_ = 0.0;
};

/// The transform of a planar shape: D(f, gamma) = f . gamma(f) / |f|^2 for every bin of lines.
struct LineMap {
  LineGrid grid;
  std::vector<float> values;  ///< grid.size() values of D, about [0, 1]; 1 = perfect symmetry
  double sigma = 0.0;         ///< width of the distance transform that the map was made with, input units
  /// Mean of the points, input frame: the point from which the paper measures r in its threshold 1 - r / R.
  Eigen::Vector2d center_of_mass = Eigen::Vector2d::Zero();

  float operator[](std::size_t index) const { return values[index]; }
  bool empty() const { return values.empty(); }

  /// Bin of the largest value; 0 for an empty map.
  std::size_t strongest() const;
};

}  // namespace pcl_symmetry
