/// Synthetic contours with known lines of symmetry.
#pragma once

#include <cmath>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt_2d.h"
#include "shapes/shapes.h"

namespace pcl_symmetry::test {

/// num_points points at equal distances along a closed polygon.
inline Points2D polygon(const std::vector<Eigen::Vector2d>& corners, int num_points) {
  const std::size_t size = corners.size();
  double length = 0.0;
  for (std::size_t i = 0; i < size; ++i) length += (corners[(i + 1) % size] - corners[i]).norm();
  Points2D points(2, num_points);
  std::size_t side = 0;
  double before = 0.0;
  for (int k = 0; k < num_points; ++k) {
    const double at = (k + 0.5) * length / num_points;
    const auto sideLength = [&] { return (corners[(side + 1) % size] - corners[side]).norm(); };
    while (at > before + sideLength() && side + 1 < size) {
      before += sideLength();
      ++side;
    }
    const double share = (at - before) / sideLength();
    points.col(k) = ((1.0 - share) * corners[side] + share * corners[(side + 1) % size]).cast<float>();
  }
  return points;
}

/// The regular n-gon in the unit circle, one corner at (0, 1).
inline std::vector<Eigen::Vector2d> regularCorners(int n) {
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < n; ++k) corners.emplace_back(-std::sin(2.0 * kPi * k / n), std::cos(2.0 * kPi * k / n));
  return corners;
}

inline Points2D regularPolygon(int n, int num_points = 2400) {
  return polygon(regularCorners(n), num_points);
}

inline Points2D rectangle(double width, double height, int num_points = 2400) {
  const double x = 0.5 * width, y = 0.5 * height;
  return polygon({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, num_points);
}

/// A star of five arms, smooth; each point moved along the radius by Gaussian noise of this deviation.
inline Points2D starfish(double noise, std::uint64_t seed, int num_points = 2400) {
  RandomStream random(seed);
  Points2D points(2, num_points);
  for (int k = 0; k < num_points; ++k) {
    const double angle = 2.0 * kPi * k / num_points;
    const double radius = 0.6 + 0.35 * std::cos(5.0 * angle) + noise * gaussian(random);
    points.col(k) = (radius * Eigen::Vector2d(std::sin(angle), std::cos(angle))).cast<float>();
  }
  return points;
}

}  // namespace pcl_symmetry::test
