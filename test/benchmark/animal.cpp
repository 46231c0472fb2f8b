#include "animal.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/constants.h"
#include "core/geometry/triangles.h"

namespace pcl_symmetry::benchmarks {

namespace {

/// Its radius in each direction.
double radiusOfAnimal(const Eigen::Vector3d& n) {
  const auto bump = [&n](double x, double y, double z, double height) {
    return height * std::exp(8.0 * (n.dot(Eigen::Vector3d(x, y, z).normalized()) - 1.0));
  };
  double r = 0.5 + bump(1.0, 0.0, 0.3, 0.5);
  for (const double side : {-1.0, 1.0})
    r += bump(0.6, side * 0.5, -1.0, 0.6) + bump(-0.6, side * 0.5, -1.0, 0.6) + bump(1.0, side * 0.3, 0.6, 0.3);
  return r;
}

/// A mesh of latitudes and longitudes.
Model meshOfAnimal() {
  constexpr int kRows = 120, kColumns = 240;
  const Eigen::AngleAxisd tilt(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
  Model model{Points(3, (kRows + 1) * kColumns), {}};
  for (int r = 0; r <= kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const double theta = kPi * r / kRows, phi = 2.0 * kPi * c / kColumns;
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      model.vertices.col(r * kColumns + c) = (radiusOfAnimal(tilt * n) * n).cast<float>();
      if (r == kRows) continue;
      const int a = r * kColumns + c, b = r * kColumns + (c + 1) % kColumns;
      model.triangles.emplace_back(a, b, b + kColumns);
      model.triangles.emplace_back(a, b + kColumns, a + kColumns);
    }
  }
  return model;
}

}  // namespace

Points Model::sample(int num_points) const {
  return sampleTriangles(vertices, triangles, num_points, 7);
}

Points Model::scan(int num_points, const Eigen::Vector3d& viewpoint) const {
  constexpr double kPixels = 350.0;  // for a slope of 1: leaves 6000 points of 40 000
  const Points points = sample(num_points);
  const Eigen::Vector3d ahead = (centerOfMass(points) - viewpoint).normalized();
  const Eigen::Vector3d u = ahead.unitOrthogonal(), v = ahead.cross(u);
  std::map<std::pair<int, int>, std::pair<double, Eigen::Index>> nearest;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - viewpoint;
    const double depth = x.dot(ahead);
    const std::pair pixel(static_cast<int>(std::floor(kPixels * x.dot(u) / depth)),
                          static_cast<int>(std::floor(kPixels * x.dot(v) / depth)));
    const auto seen = nearest.try_emplace(pixel, depth, i).first;
    if (depth < seen->second.first) seen->second = {depth, i};
  }
  Points seen(3, static_cast<Eigen::Index>(nearest.size()));
  Eigen::Index k = 0;
  for (const auto& [pixel, point] : nearest) seen.col(k++) = points.col(point.second);
  return seen;
}

const Model& animal() {
  static const Model model = meshOfAnimal();
  return model;
}

}  // namespace pcl_symmetry::benchmarks
