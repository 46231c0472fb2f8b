#include "core/geometry/surface_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(LocalGeometry, SpacingMeasuresDensity) {
  // spacing^2 * density = pi r_k^2 density / k; the count within r is Poisson, so that pi r_k^2 density is Gamma(k)
  // with mean k: the mean of the ratio is 1, that of n samples of 8 neighbors each (every point counts in about 8
  // neighborhoods, so there are n / 8 independent ones) has a standard error of about 1 / sqrt(n).
  for (const int num_points : {2000, 8000}) {
    const Points points = sphere(num_points, 6).cloud();
    const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 0);
    const double density = num_points / (4.0 * kPi);
    double mean = 0.0;
    for (const float spacing : geometry.spacing) mean += spacing * spacing * density / num_points;
    EXPECT_NEAR(mean, 1.0, 4.0 / std::sqrt(num_points)) << num_points;
  }
}

TEST(LocalGeometry, OfFewOrCoincidentPointsIsDefined) {
  for (const Points& points : {Points(Points::Constant(3, 1, 1.0f)), Points(Points::Constant(3, 20, 1.0f)),
                               Points((Points(3, 2) << 0, 1, 0, 0, 0, 0).finished())}) {
    const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 1);
    ASSERT_EQ(geometry.normals.cols(), points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      EXPECT_NEAR(geometry.normals.col(i).norm(), 1.0f, 1e-5f);
      EXPECT_TRUE(std::isfinite(geometry.spacing[i]));
    }
  }
}

TEST(LocalGeometry, FitsTheAxisOfLeastSpread) {
  const Points points = asymmetricBlob(1000, 8).cloud();
  const auto search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, 8, 1);
  std::vector<int> nearest;
  std::vector<float> sq_distances;
  search->search(points, 9, nearest, sq_distances);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Matrix3Xd offsets(3, 9);
    for (int k = 0; k < 9; ++k) offsets.col(k) = points.col(nearest[i * 9 + k]).cast<double>();
    offsets.colwise() -= offsets.rowwise().mean().eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(offsets * offsets.transpose());
    // Floats round the moments by 1e-6 of the largest: axes of nearly equal moments are free by that.
    const Eigen::Vector3d normal = geometry.normals.col(i).cast<double>();
    const double least = solver.eigenvalues()[0], found = normal.dot(offsets * offsets.transpose() * normal);
    EXPECT_NEAR(found, least, 1e-5 * solver.eigenvalues()[2]) << i;
    EXPECT_NEAR(geometry.roughness[i], std::sqrt(std::max(0.0, found) / 6.0), 1e-2 * std::sqrt(found) + 1e-4) << i;
  }
}

}  // namespace
