#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/base/random.h"
#include "core/geometry/axis_rotations.h"
#include "core/matching/shape_signature.h"
#include "core/matching/signature_projection.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {
namespace {

/// Points drawn at random on the surface of a box from -half to half; every tenth one in a knob, so that nothing is
/// symmetric.
Points knobbedBox(const Eigen::Vector3d& half, const Eigen::Vector3d& knob, int num_points, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(3, num_points);
  const Eigen::Vector3d areas(half.y() * half.z(), half.z() * half.x(), half.x() * half.y());
  for (int i = 0; i < num_points; ++i) {
    Eigen::Vector3d x;
    if (i % 10 == 0) {
      for (int k = 0; k < 3; ++k) x[k] = knob[k] + 0.1 * (random.uniform() - 0.5);
    } else {
      double share = random.uniform() * areas.sum();
      int axis = 0;
      while (axis < 2 && share >= areas[axis]) share -= areas[axis++];
      for (int k = 0; k < 3; ++k) x[k] = half[k] * (2.0 * random.uniform() - 1.0);
      x[axis] = random.uniform() < 0.5 ? -half[axis] : half[axis];
    }
    points.col(i) = x.cast<float>();
  }
  return points;
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sq = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sq += std::pow(a[i] - b[i], 2);
  return std::sqrt(sq);
}

const Eigen::Matrix3d kOwnAxes = Eigen::Matrix3d::Identity();

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

/// Signatures of different boxes in their own axes.
Eigen::MatrixXf boxSignatures(int count) {
  Eigen::MatrixXf signatures(kSignatureSize, count);
  for (int i = 0; i < count; ++i) {
    RandomStream random(100 + static_cast<std::uint64_t>(i));
    const Eigen::Vector3d half(0.3 + random.uniform(), 0.3 + random.uniform(), 0.3 + random.uniform());
    const Eigen::Vector3d knob = half.cwiseProduct(Eigen::Vector3d(1.0, random.uniform(), random.uniform()));
    const auto signature =
        shapeSignature(knobbedBox(half, knob, 3000, 7 + static_cast<std::uint64_t>(i)), Eigen::Matrix3d::Identity());
    signatures.col(i) = Eigen::Map<const Eigen::VectorXf>(signature.data(), kSignatureSize);
  }
  return signatures;
}

TEST(SignatureProjection, RotatesAsSignaturesDo) {
  const Eigen::MatrixXf signatures = boxSignatures(6);
  // All there is to know of 6 shapes: then the space of the components is closed.
  ProjectionOptions options;
  options.num_dimensions = 6 * kNumAxisRotations;
  const SignatureProjection projection = SignatureProjection::fit(signatures, options);
  Eigen::VectorXf rotated(kSignatureSize);
  const Eigen::VectorXf compact = projection.project(signatures.col(3));
  EXPECT_NEAR(compact.norm(), 1.0, 1e-5);
  const Eigen::MatrixXf rotations = projection.rotations(compact);
  for (int r = 0; r < kNumAxisRotations; ++r) {
    rotateSignature(signatures.col(3).data(), r, rotated.data());
    EXPECT_LT((projection.project(rotated) - rotations.col(r)).norm(), 0.05) << "rotation " << r;
  }
}

TEST(SignatureProjection, IsTheSameWithAnyNumberOfThreadsAndAfterStorage) {
  const Eigen::MatrixXf signatures = boxSignatures(4);
  ProjectionOptions options;
  options.num_dimensions = 32;
  options.num_threads = 1;
  const SignatureProjection one = SignatureProjection::fit(signatures, options);
  options.num_threads = 3;
  const SignatureProjection many = SignatureProjection::fit(signatures, options);
  EXPECT_EQ(one.toValues(), many.toValues());
  const SignatureProjection stored = SignatureProjection::fromValues(one.toValues());
  EXPECT_EQ(stored.numDimensions(), 32);
  EXPECT_EQ(stored.project(signatures), one.project(signatures));
  std::vector<float> cut = one.toValues();
  cut.pop_back();
  EXPECT_THROW(SignatureProjection::fromValues(cut), std::invalid_argument);
}

TEST(SignatureProjection, RefusesWhatItCannotUse) {
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf(kSignatureSize, 0)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Ones(5, 5)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Zero(kSignatureSize, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
