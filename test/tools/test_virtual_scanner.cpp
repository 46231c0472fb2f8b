#include "scanner/virtual_scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "pcl/pcl_meshes.h"

namespace {

using namespace pcl_symmetry::apps;

using pcl_symmetry::test::boxMesh;

Eigen::Vector3d positionOf(const pcl::PointXYZ& point) {
  return point.getVector3fMap().cast<double>();
}

bool equalBytes(const VirtualScan& a, const VirtualScan& b) {
  if (a.cloud->size() != b.cloud->size()) return false;
  for (std::size_t i = 0; i < a.cloud->size(); ++i) {
    if (std::memcmp((*a.cloud)[i].data, (*b.cloud)[i].data, 3 * sizeof(float)) != 0) return false;
  }
  return true;
}

class BoxScan : public testing::Test {
protected:
  const Eigen::Vector3f half_{0.5f, 0.8f, 1.2f}, center_{10, -20, 5};
  const Eigen::AlignedBox3d box_{(center_ - half_).cast<double>(), (center_ + half_).cast<double>()};
  const VirtualScanner scanner_{boxMesh(half_, center_)};
};

TEST_F(BoxScan, EveryPixelSeesTheFirstSurfaceOnItsRay) {
  for (const Eigen::Vector3d& direction : cubeCorners()) {
    const VirtualScan scan = scanner_.scan(direction);
    const double tan_half = std::tan(0.2);
    const int n = static_cast<int>(scan.cloud->width);
    ASSERT_EQ(scan.cloud->height, scan.cloud->width);
    int num_hits = 0;
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) {
        const Eigen::Vector3d in_sensor((2 * (column + 0.5) / n - 1) * tan_half, (2 * (row + 0.5) / n - 1) * tan_half,
                                        1);
        const Eigen::Vector3d origin = scan.T_scan_sensor.translation();
        const Eigen::Vector3d ray = scan.T_scan_sensor.linear() * in_sensor;
        const double entry = pcl_symmetry::test::Block{center_.cast<double>(), half_.cast<double>()}.hit(origin, ray);
        const pcl::PointXYZ& point = scan.cloud->at(column, row);
        ASSERT_EQ(std::isfinite(point.x), std::isfinite(entry)) << column << " " << row;
        if (!std::isfinite(entry)) continue;
        ++num_hits;
        EXPECT_LT((positionOf(point) - (origin + entry * ray)).norm(), 4e-6) << "float has 2e-6 at 20";
      }
    }
    EXPECT_EQ(num_hits, scan.num_points);
  }
}

TEST_F(BoxScan, ScannerStandsAtTwoDiagonalsAndLooksAtTheCenter) {
  const auto corners = cubeCorners();
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(corners[i].x() > 0, (i & 1) != 0);
    EXPECT_EQ(corners[i].y() > 0, (i & 2) != 0);
    EXPECT_EQ(corners[i].z() > 0, (i & 4) != 0);
    const VirtualScan scan = scanner_.scan(corners[i]);
    const Eigen::Vector3d expected = box_.center() + 2 * box_.diagonal().norm() * corners[i];
    EXPECT_LT((scan.T_scan_sensor.translation() - expected).norm(), 1e-6);
    EXPECT_LT((scan.cloud->sensor_origin_.head<3>().cast<double>() - expected).norm(), 1e-5);
    const Eigen::Matrix3f axes = scan.cloud->sensor_orientation_.toRotationMatrix();
    EXPECT_LT((axes.col(2).cast<double>() + corners[i]).norm(), 1e-6) << "z looks forward";
    EXPECT_LT(axes(2, 1), 0) << "y looks down";
    EXPECT_NEAR(axes.determinant(), 1, 1e-5);
  }
}

TEST_F(BoxScan, TakesNoLargerPictureThanAllowed) {
  VirtualScannerOptions options;
  options.num_points = 100'000;
  options.max_resolution = 100;
  const VirtualScan scan = scanner_.scan({1, 1, 1}, options);
  EXPECT_EQ(scan.cloud->width, 100u);
  EXPECT_LT(scan.num_points, 10'000);
}

TEST_F(BoxScan, SameBytesForAnyNumberOfThreads) {
  VirtualScannerOptions options;
  options.noise = 0.01;
  options.random_pose = true;
  options.num_threads = 1;
  const VirtualScan one = scanner_.scan({1, 1, 1}, options);
  for (const int threads : {2, 8}) {
    options.num_threads = threads;
    EXPECT_TRUE(equalBytes(one, scanner_.scan({1, 1, 1}, options)));
  }
  options.seed = 1;
  EXPECT_FALSE(equalBytes(one, scanner_.scan({1, 1, 1}, options)));
}

TEST_F(BoxScan, NoiseMovesPointsAlongTheirRays) {
  VirtualScannerOptions options;
  const VirtualScan clean = scanner_.scan({1, 1, 1}, options);
  options.noise = 0.01;
  const VirtualScan noisy = scanner_.scan({1, 1, 1}, options);
  ASSERT_EQ(clean.cloud->size(), noisy.cloud->size());
  double sum = 0, sq_sum = 0;
  for (std::size_t i = 0; i < clean.cloud->size(); ++i) {
    if (!std::isfinite((*clean.cloud)[i].x)) continue;
    const Eigen::Vector3d ray = (positionOf((*clean.cloud)[i]) - clean.T_scan_sensor.translation()).normalized();
    const Eigen::Vector3d moved = positionOf((*noisy.cloud)[i]) - positionOf((*clean.cloud)[i]);
    EXPECT_LT((moved - ray.dot(moved) * ray).norm(), 1e-5);
    sum += ray.dot(moved);
    sq_sum += ray.dot(moved) * ray.dot(moved);
  }
  const double sigma = 0.01 * scanner_.diagonal(), n = clean.num_points;
  EXPECT_LT(std::abs(sum / n), 4 * sigma / std::sqrt(n)) << "four standard errors";
  EXPECT_NEAR(std::sqrt(sq_sum / n), sigma, 4 * sigma / std::sqrt(2 * n));
  options.noise_stream = 1;
  EXPECT_FALSE(equalBytes(noisy, scanner_.scan({1, 1, 1}, options)));
}

/// The mean of uniformly distributed rotation matrices is zero; each entry has variance 1/3.
TEST(RandomPose, IsUniform) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  const int n = 3000;
  for (int seed = 0; seed < n; ++seed) {
    const Eigen::Isometry3d pose = randomPose(static_cast<std::uint64_t>(seed), 2.0);
    EXPECT_TRUE((pose.linear() * pose.linear().transpose()).isIdentity(1e-12));
    EXPECT_LE(pose.translation().cwiseAbs().maxCoeff(), 2.0);
    mean += pose.linear() / n;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5 * std::sqrt(1.0 / 3 / n));
}

TEST(VirtualScanner, WorksAtAnyScale) {
  for (const float scale : {1e-9f, 1e9f}) {
    const VirtualScanner scanner(boxMesh(scale * Eigen::Vector3f(0.5f, 0.8f, 1.2f)));
    const VirtualScan scan = scanner.scan({1, 1, 1});
    EXPECT_NEAR(scan.num_points, 10000, 500);
  }
}

TEST(VirtualScanner, SaysWhenTheModelReachesBeyondThePicture) {
  const VirtualScanner scanner(boxMesh({1, 1, 1}));
  VirtualScannerOptions options;
  EXPECT_TRUE(scanner.scan({1, 1, 1}, options).cropped) << "0.47 diagonals from the axis, the picture shows 0.41";
  EXPECT_FALSE(scanner.scan({1, 0, 0}, options).cropped);
  options.field_of_view = 0.6;
  EXPECT_FALSE(scanner.scan({1, 1, 1}, options).cropped);
}

TEST(VirtualScanner, RefusesWhatItCannotScan) {
  EXPECT_THROW(VirtualScanner{pcl::PolygonMesh()}, std::invalid_argument);
  EXPECT_THROW(VirtualScanner{boxMesh({0, 0, 0})}, std::invalid_argument);
  EXPECT_THROW(VirtualScanner{boxMesh({1, 1, NAN})}, std::invalid_argument);
}

}  // namespace
