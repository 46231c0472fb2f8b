#include "core/geometry/mesh_sampling.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace {

using namespace pcl_symmetry;

TEST(SampleTriangles, SpreadsPointsByArea) {
  // Two triangles of areas 1 and 3: one point in each of equal shares of the area, so that the counts are exact.
  const Points vertices = (Points(3, 5) << 0, 2, 0, 6, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1).finished();
  const Points points = sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000);
  ASSERT_EQ(points.cols(), 4000);
  int num_first = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f p = points.col(i);
    const bool first = i < 1000;  // in the order of the triangles
    num_first += first;
    if (first) {
      EXPECT_EQ(p.z(), 0.0f);
      EXPECT_LE(0.5f * p.x() + p.y(), 1.0f + 1e-6f);
      mean += p.cast<double>() / 1000.0;
    } else {
      EXPECT_EQ(p.y(), 0.0f);
      EXPECT_LE(p.x() / 6.0f + p.z(), 1.0f + 1e-6f);
    }
    EXPECT_GE(p.minCoeff(), 0.0f);
  }
  // Uniform in the triangle: its centroid, with standard deviations of 2 / sqrt(18 * 1000) and half of it.
  EXPECT_NEAR(mean.x(), 2.0 / 3.0, 4.0 * 0.015);
  EXPECT_NEAR(mean.y(), 1.0 / 3.0, 4.0 * 0.0075);
  EXPECT_EQ(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000), points);
  EXPECT_NE(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000, 2), points);
}

TEST(SampleTriangles, LeavesOutWhatIsNotFinite) {
  Points vertices(3, 4);
  vertices << 0, 2, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1;
  vertices(0, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(sampleTriangles(vertices, {{0, 1, 2}, {0, 1, 3}}, 100).allFinite());
}

TEST(SampleTriangles, RefusesWhatHasNoSurface) {
  const Points vertices = (Points(3, 3) << 0, 2, 1, 0, 0, 0, 0, 0, 0).finished();
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 2}}, 10), std::invalid_argument);  // on a line
  EXPECT_THROW(sampleTriangles(vertices, {}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 3}}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, -1, 2}}, 10), std::invalid_argument);
}

}  // namespace
