#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "core/geometry/axis_rotations.h"
#include "core/matching/shape_signature.h"
#include "shapes/knobbed_box.h"

namespace pcl_symmetry {

namespace {

using test::knobbedBox;

double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sq = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sq += std::pow(a[i] - b[i], 2);
  return std::sqrt(sq);
}

const Eigen::Matrix3d kOwnAxes = Eigen::Matrix3d::Identity();

}  // namespace

TEST(ShapeSignature, HasUnitNormWhateverUnitAndPlace) {
  const Points box = knobbedBox({1.0, 0.7, 0.4}, {1.0, 0.5, 0.3}, 20'000, 1);
  const auto signature = shapeSignature(box, kOwnAxes);
  ASSERT_EQ(signature.size(), static_cast<std::size_t>(kSignatureSize));
  EXPECT_NEAR(std::inner_product(signature.begin(), signature.end(), signature.begin(), 0.0), 1.0, 1e-4);
  for (const float unit : {1e-12f, 1e12f}) {
    const Points moved = (unit * box).colwise() + unit * Eigen::Vector3f(3.0f, -2.0f, 1.0f);
    EXPECT_LT(distance(shapeSignature(moved, kOwnAxes), signature), 0.1);
  }
}

TEST(ShapeSignature, TurnsWithTheAxes) {
  const Points box = knobbedBox({1.0, 0.7, 0.4}, {1.0, 0.5, 0.3}, 20'000, 1);
  const auto signature = shapeSignature(box, kOwnAxes);
  std::vector<float> rotated(kSignatureSize);
  for (int r = 0; r < kNumAxisRotations; ++r) {
    const Eigen::Matrix3d axes = axisRotations()[static_cast<std::size_t>(r)].cast<double>().transpose();
    const auto direct = shapeSignature(box, axes);
    rotateSignature(signature.data(), r, rotated.data());
    EXPECT_LT(distance(direct, rotated), 1e-3) << "rotation " << r;
    EXPECT_TRUE(r == 0 || distance(direct, signature) > 0.1) << "rotation " << r;
  }
}

TEST(ShapeSignature, TellsWallsFromFloors) {
  Points wall(3, 900), floor(3, 900);
  for (int i = 0; i < 900; ++i) {
    const float u = static_cast<float>(i % 30) / 30.0f, v = static_cast<float>(i / 30) / 30.0f;
    wall.col(i) << u, v, 0.2f * u;
    floor.col(i) << u, v, -0.2f * u;
  }
  EXPECT_GT(distance(shapeSignature(wall, kOwnAxes), shapeSignature(floor, kOwnAxes)), 0.3);
}

TEST(ShapeSignature, RefusesPointsWithoutExtent) {
  EXPECT_THROW(shapeSignature(Points(3, 0), kOwnAxes), std::invalid_argument);
  EXPECT_THROW(shapeSignature(Points::Ones(3, 5), kOwnAxes), std::invalid_argument);
  Points broken = Points::Random(3, 5);
  broken(1, 2) = std::nanf("");
  EXPECT_THROW(shapeSignature(broken, kOwnAxes), std::invalid_argument);
}

TEST(SignatureFrames, KeepTheFirstAxisAndSpreadTheOthers) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Points box = rotation.cast<float>() * knobbedBox({1.0, 0.7, 0.4}, {0.0, 0.0, 0.0}, 20'000, 1);
  SymmetryFrame frame;
  frame.axes.col(0) = rotation.col(1);
  frame.axes.col(1) = (rotation.col(0) + rotation.col(2)).normalized();
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  const auto frames = signatureFrames(box, frame);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(frames[1].isApprox(frame.axes));
  EXPECT_TRUE(frames[0].col(0).isApprox(rotation.col(1)));
  EXPECT_GT(std::abs(frames[0].col(1).dot(rotation.col(0))), 0.999);
  EXPECT_NEAR(frames[0].determinant(), 1.0, 1e-9);
}

}  // namespace pcl_symmetry
