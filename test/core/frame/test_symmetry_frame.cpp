#include "pcl_symmetry/core/symmetry_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapes/complaint.h"
#include "shapes/scans.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using test::kDegree;
using test::Sampling;

/// Largest angle from a column of \p axes to the nearest column of \p expected, as lines.
double axisError(const Eigen::Matrix3d& axes, const Eigen::Matrix3d& expected) {
  const Eigen::Matrix3d cosines = (axes.transpose() * expected).cwiseAbs();
  return std::acos(std::min(1.0, cosines.rowwise().maxCoeff().minCoeff()));
}

void expectRightHanded(const SymmetryFrame& frame) {
  EXPECT_LT((frame.axes.transpose() * frame.axes - Eigen::Matrix3d::Identity()).norm(), 1e-5);
  EXPECT_GT(frame.axes.determinant(), 0.9);
}

void expectSame(const SymmetryFrame& a, const SymmetryFrame& b) {
  EXPECT_EQ(a.center, b.center);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.scores, b.scores);
  EXPECT_EQ(a.revolution_axis, b.revolution_axis);
  ASSERT_EQ(a.probable.size(), b.probable.size());
  for (std::size_t i = 0; i < a.probable.size(); ++i) EXPECT_EQ(a.probable[i].probability, b.probable[i].probability);
  ASSERT_EQ(a.equivalent.size(), b.equivalent.size());
  for (std::size_t i = 0; i < a.equivalent.size(); ++i)
    EXPECT_EQ(a.equivalent[i].matrix(), b.equivalent[i].matrix()) << i;
}

void expectSameTurns(const SymmetryFrame& a, const SymmetryFrame& b) {
  ASSERT_EQ(a.turns.size(), b.turns.size());
  for (std::size_t i = 0; i < a.turns.size(); ++i) {
    EXPECT_EQ(a.turns[i].point, b.turns[i].point);
    EXPECT_EQ(a.turns[i].confidence, b.turns[i].confidence);
  }
}

/// A box with a fin at the end of its back, like the body of an airplane: one plane, y = 0, one nearly, x = 0, and
/// nothing across z. So order and signs of its axes are not left to chance.
test::Shape finnedBox(std::uint64_t seed) {
  test::Shape shape = test::box({1.0, 0.45, 0.25}, 6000, Sampling::Random, seed);
  const test::Shape fin = test::box({0.15, 0.08, 0.5}, 1200, Sampling::Random, seed + 1);
  const Eigen::Index size = shape.points.cols();
  shape.points.conservativeResize(3, size + fin.points.cols());
  shape.points.rightCols(fin.points.cols()) = fin.points.colwise() + Eigen::Vector3d(-0.8, 0.0, 0.7);
  return shape;
}

TEST(SymmetryFrame, OfABoxIsItsAxesAndItsCenter) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Eigen::Isometry3d pose = test::randomPose(seed);
    const auto shape = test::moved(test::box(6000, Sampling::Random, seed), pose);
    const SymmetryFrame frame = symmetryFrame(shape.cloud());
    expectRightHanded(frame);
    EXPECT_LT(axisError(frame.axes, pose.linear()), 1.5 * kDegree) << seed;
    EXPECT_LT((frame.center - pose.translation()).norm(), 0.01 * test::diagonal(shape.cloud())) << seed;
    EXPECT_GT(frame.scores.minCoeff(), 0.85);
    EXPECT_EQ(frame.revolution_axis, -1);
  }
}

TEST(SymmetryFrame, TurnsMovesAndScalesWithTheInput) {
  const test::Shape shape = finnedBox(5);
  const SymmetryFrame expected = symmetryFrame(shape.cloud());
  EXPECT_GT(std::abs(expected.axes(1, 0)), std::cos(3.0 * kDegree));
  EXPECT_GT(std::abs(expected.axes(0, 1)), std::cos(3.0 * kDegree));
  EXPECT_GT(expected.axes(2, 2), std::cos(3.0 * kDegree)) << "towards the fin";
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Eigen::Isometry3d pose = test::randomPose(seed);
    const double scale = std::pow(10.0, static_cast<double>(seed) - 3.0);
    const test::Shape image = test::scaled(test::moved(shape, pose), scale);
    const SymmetryFrame frame = symmetryFrame(image.cloud());
    EXPECT_LT((frame.center - scale * (pose * expected.center)).norm(), 0.015 * test::diagonal(image.cloud())) << seed;
    EXPECT_LT(Eigen::AngleAxisd(frame.axes.transpose() * pose.linear() * expected.axes).angle(), 3.0 * kDegree) << seed;
  }
}

TEST(SymmetryFrame, OfAMugDoesNotFollowTheHandle) {
  for (const double reach : {0.3, 0.6}) {
    test::Shape mug = test::cylinder(6000, 2);
    const Eigen::Index size = mug.points.cols(), added = 1200;
    mug.points.conservativeResize(3, size + added);
    RandomStream random(4);
    for (Eigen::Index i = 0; i < added; ++i) {  // half a ring in the plane y = 0, upright beside the wall
      const double around = test::kPi * (random.uniform() - 0.5), tube = 2.0 * test::kPi * random.uniform();
      const double r = 0.5 + 0.08 * std::cos(tube);
      mug.points.col(size + i) =
          Eigen::Vector3d(0.6 + reach / 0.5 * r * std::cos(around), 0.08 * std::sin(tube), r * std::sin(around));
    }
    const Eigen::Isometry3d pose = test::randomPose(11);
    const Points cloud = test::moved(mug, pose).cloud();
    const SymmetryFrame frame = symmetryFrame(cloud);
    EXPECT_LT(axisError(frame.axes, pose.linear()), 3.0 * kDegree) << reach;
    EXPECT_LT((frame.center - pose.translation()).norm(), 0.03 * test::diagonal(cloud)) << reach;
    EXPECT_GT((centerOfMass(cloud) - pose.translation()).norm(), 0.03 * test::diagonal(cloud)) << reach;
  }
}

TEST(SymmetryFrame, ListsTheFramesThatSymmetryLeavesEquallyGood) {
  // The frame itself is the first, all have its center at the origin, and all are rotations.
  const Eigen::Isometry3d pose = test::randomPose(2);
  const SymmetryFrame box = symmetryFrame(test::moved(finnedBox(8), pose).cloud());
  ASSERT_GE(box.equivalent.size(), 4u);
  EXPECT_EQ(box.equivalent[0].matrix(), box.T_canonical_input.matrix());
  for (const Eigen::Isometry3d& T : box.equivalent) EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-5);

  // Of a cube each of its 24 rotations is there.
  const auto cube = test::moved(test::cube(6000, Sampling::Random, 3), pose);
  const SymmetryFrame frame = symmetryFrame(cube.cloud());
  ASSERT_LT(axisError(frame.axes, pose.linear()), 2.0 * kDegree) << "across faces, not edges: the surface agrees";
  EXPECT_GE(frame.equivalent.size(), 24u);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Isometry3d quarter(Eigen::AngleAxisd(0.5 * test::kPi, frame.axes.col(axis)));
    const Eigen::Matrix3d rotated = frame.T_canonical_input.linear() * quarter.linear();
    const bool listed = std::any_of(frame.equivalent.begin(), frame.equivalent.end(), [&](const auto& T) {
      return Eigen::AngleAxisd(T.linear() * rotated.transpose()).angle() < 5.0 * kDegree;
    });
    EXPECT_TRUE(listed) << axis;
  }
}

TEST(SymmetryFrame, ListsFramesThatMayBeTheShapesOwnWithTheirProbabilities) {
  const Eigen::Isometry3d pose = test::randomPose(4);
  const SymmetryFrame frame = symmetryFrame(test::moved(finnedBox(5), pose).cloud());
  ASSERT_GE(frame.probable.size(), 2u);
  EXPECT_EQ(frame.probable[0].axes, frame.axes) << "the frame itself is the first";
  EXPECT_EQ(frame.probable[0].center, frame.center);
  EXPECT_GT(frame.probable[0].probability, 0.5);
  double sum = 0.0;
  for (const ProbableFrame& other : frame.probable) {
    EXPECT_LT((other.axes.transpose() * other.axes - Eigen::Matrix3d::Identity()).norm(), 1e-5);
    EXPECT_GT(other.axes.determinant(), 0.9);
    EXPECT_GE(other.probability, 0.0);
    sum += other.probability;
  }
  EXPECT_LT(sum, 1.0) << "none of them may be right";
  for (std::size_t i = 2; i < frame.probable.size(); ++i)
    EXPECT_LE(frame.probable[i].probability, frame.probable[i - 1].probability);

  FrameOptions options;
  options.probabilities = false;
  const SymmetryFrame without = symmetryFrame(test::moved(finnedBox(5), pose).cloud(), options);
  EXPECT_TRUE(without.probable.empty());
  EXPECT_EQ(without.T_canonical_input.matrix(), frame.T_canonical_input.matrix());
}

TEST(SymmetryFrame, FindsAxesOfRevolutionAndSpheres) {
  const Eigen::Isometry3d pose = test::randomPose(9);
  const SymmetryFrame cylinder = symmetryFrame(test::moved(test::cylinder(8000, 1), pose).cloud());
  ASSERT_GE(cylinder.revolution_axis, 0);
  ASSERT_LE(cylinder.revolution_axis, 2);
  EXPECT_GT(std::abs(cylinder.axes.col(cylinder.revolution_axis).dot(pose.linear().col(2))), std::cos(2.0 * kDegree));
  EXPECT_LT((cylinder.center - pose.translation()).norm(), 0.03);

  const SymmetryFrame sphere = symmetryFrame(test::moved(test::sphere(6000, 1), pose).cloud());
  EXPECT_EQ(sphere.revolution_axis, 3);
  EXPECT_LT((sphere.center - pose.translation()).norm(), 0.03);
}

TEST(SymmetryFrame, OfAScanIsThatOfTheWhole) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1.0, 1.3, 0.8), Eigen::Vector3d(-1.2, 0.7, 1.0), Eigen::Vector3d(0.8, -1.0, -1.1)}) {
    const test::Scan scan = test::scan(test::blockBox(), 6.0 * direction.normalized());
    const Points cloud = scan.cloud();
    const Visibility visibility = scan.visibility();
    const SymmetryFrame frame = symmetryFrame(cloud, {}, &visibility);
    expectRightHanded(frame);
    EXPECT_LT(axisError(frame.axes, Eigen::Matrix3d::Identity()), 2.0 * kDegree) << direction.transpose();
    const double diagonal = 2.0 * Eigen::Vector3d(1.0, 0.7, 0.45).norm();
    EXPECT_LT(frame.center.norm(), 0.04 * diagonal) << direction.transpose();
    EXPECT_GT(centerOfMass(cloud).norm(), 2.0 * frame.center.norm()) << direction.transpose();
  }
}

/// The box of blocks has half turns; from a corner one of them is confirmed by what was seen.
TEST(SymmetryFrame, OfAScanListsTurnsUnlessToldNotTo) {
  const test::Scan scan = test::scan(test::blockBox(), 6.0 * Eigen::Vector3d(1.0, 1.3, 0.8).normalized());
  const Points cloud = scan.cloud();
  const Visibility visibility = scan.visibility();
  const SymmetryFrame frame = symmetryFrame(cloud, {}, &visibility);
  for (std::size_t i = 0; i < frame.turns.size(); ++i) {
    EXPECT_GE(frame.turns[i].confidence, DetectionOptions().min_possible);
    EXPECT_LE(frame.turns[i].confidence, i == 0 ? 1.0 : frame.turns[i - 1].confidence);
    EXPECT_NEAR(frame.turns[i].direction.norm(), 1.0, 1e-9);
    EXPECT_EQ(frame.turns[i].fold % 2, 0) << "a box has no other turns";
  }
  FrameOptions options;
  options.turns = false;
  EXPECT_TRUE(symmetryFrame(cloud, options, &visibility).turns.empty());
  expectSame(symmetryFrame(cloud, options, &visibility), frame);
  EXPECT_TRUE(symmetryFrame(cloud).turns.empty()) << "whole objects have objectSymmetries()";
}

TEST(SymmetryFrame, IsTheSameForAnyNumberOfThreads) {
  const test::Scan scan = test::scan(test::blockChair(), {3.0, -4.0, 3.5});
  const Points cloud = scan.cloud();
  const Visibility visibility = scan.visibility();
  FrameOptions options;
  options.num_threads = 1;
  const SymmetryFrame expected = symmetryFrame(cloud, options, &visibility);
  const SymmetryFrame expected_whole = symmetryFrame(cloud, options);
  for (const int num_threads : {2, 8}) {
    options.num_threads = num_threads;
    const SymmetryFrame frame = symmetryFrame(cloud, options, &visibility);
    expectSame(frame, expected);
    expectSameTurns(frame, expected);
    expectSame(symmetryFrame(cloud, options), expected_whole);
  }
}

TEST(SymmetryFrame, AsPublishedFindsTheAxesOfABox) {
  FrameOptions options;
  options.as_published = true;
  const Eigen::Isometry3d pose = test::randomPose(4);
  const auto shape = test::moved(test::box(6000, Sampling::Random, 4), pose);
  const SymmetryFrame frame = symmetryFrame(shape.cloud(), options);
  expectRightHanded(frame);
  EXPECT_LT(axisError(frame.axes, pose.linear()), 4.0 * kDegree) << "as fine as the bins of the map";
  EXPECT_LT((frame.center - pose.translation()).norm(), 0.05);
  EXPECT_EQ(frame.equivalent.size(), 4u);
}

TEST(SymmetryFrame, OfDegeneratePointsIsFiniteOrRefused) {
  RandomStream random(1);
  Points line(3, 100), flat(3, 400), two(3, 2), same = Points::Ones(3, 20);
  for (Eigen::Index i = 0; i < line.cols(); ++i) line.col(i) = random.uniform() * Eigen::Vector3f(1.0f, 2.0f, 3.0f);
  for (Eigen::Index i = 0; i < flat.cols(); ++i)
    flat.col(i) = Eigen::Vector3f(random.uniform(), random.uniform(), 0.0f);
  two << 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 2.0f;
  for (const Points& points : {line, flat, two}) {
    const SymmetryFrame frame = symmetryFrame(points);
    expectRightHanded(frame);
    EXPECT_TRUE(frame.center.allFinite());
    EXPECT_TRUE(frame.scores.allFinite());
    const BoundingBall ball = boundingBall(points);
    EXPECT_LE((frame.center - ball.center).norm(), 1.1 * ball.radius);
  }
  EXPECT_THROW(symmetryFrame(same), std::invalid_argument);
  EXPECT_THROW(symmetryFrame(Points(3, 0)), std::invalid_argument);
}

TEST(FrameOptions, NamesFieldValueAndRule) {
  FrameOptions options;
  options.tie = -0.5;
  EXPECT_EQ(test::complaintOf<std::invalid_argument>([&] { options.validate(); }), "tie = -0.5, must be >= 0");
}

}  // namespace
}  // namespace pcl_symmetry
