/// The frame of a shape, and what it is made of: profiles along directions, candidates, and the axes that are chosen.
#include "pcl_symmetry/core/symmetry_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/frame/canonical_frame.h"
#include "core/frame/plane_profiles.h"
#include "core/frame/probable_frames.h"
#include "core/geometry/cloud_extent.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/complaint.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

using namespace test;

/// Largest angle from a column of \p axes to the nearest column of \p expected, as lines.
double axisError(const Eigen::Matrix3d& axes, const Eigen::Matrix3d& expected) {
  const Eigen::Matrix3d cosines = (axes.transpose() * expected).cwiseAbs();
  return std::acos(std::min(1.0, cosines.rowwise().maxCoeff().minCoeff()));
}

void expectRightHanded(const Eigen::Matrix3d& axes) {
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-5);
  EXPECT_GT(axes.determinant(), 0.9);
}

void expectSame(const SymmetryFrame& a, const SymmetryFrame& b) {
  EXPECT_EQ(a.center, b.center);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.scores, b.scores);
  EXPECT_EQ(a.revolution_axis, b.revolution_axis);
  EXPECT_EQ(valuesOf(a.probable, &ProbableFrame::probability), valuesOf(b.probable, &ProbableFrame::probability));
  EXPECT_EQ(matricesOf(a.equivalent), matricesOf(b.equivalent));
}

/// A box with a fin at the end of its back, like the body of an airplane: one plane, y = 0, one nearly, x = 0, and
/// nothing across z. So order and signs of its axes are not left to chance.
Points finnedBox(std::uint64_t seed) {
  return joined(
      box({1.0, 0.45, 0.25}, 6000, Sampling::Random, seed).cloud(),
      box({0.15, 0.08, 0.5}, 1200, Sampling::Random, seed + 1).cloud().colwise() + Eigen::Vector3f(-0.8f, 0.0f, 0.7f));
}

TEST(SymmetryFrame, TurnsMovesAndScalesWithTheInput) {
  const Points points = finnedBox(5);
  const SymmetryFrame expected = symmetryFrame(points);
  EXPECT_GT(std::abs(expected.axes(1, 0)), std::cos(3.0 * kDegree));
  EXPECT_GT(std::abs(expected.axes(0, 1)), std::cos(3.0 * kDegree));
  EXPECT_GT(expected.axes(2, 2), std::cos(3.0 * kDegree)) << "toward the fin";
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Eigen::Isometry3d pose = randomPose(seed);
    const double scale = std::pow(10.0, 2.0 * static_cast<double>(seed) - 3.0);
    const Points image = static_cast<float>(scale) * moved(points, pose);
    const SymmetryFrame frame = symmetryFrame(image);
    EXPECT_LT((frame.center - scale * (pose * expected.center)).norm(), 0.015 * diagonal(image)) << seed;
    EXPECT_LT(angleOf(frame.axes.transpose() * pose.linear() * expected.axes), 3.0 * kDegree) << seed;
  }
}

TEST(SymmetryFrame, OfAMugDoesNotFollowTheHandle) {
  for (const double reach : {0.3, 0.6}) {
    Points handle(3, 1200);
    RandomStream random(4);
    for (Eigen::Index i = 0; i < handle.cols(); ++i) {  // half a ring in the plane y = 0, upright beside the wall
      const double around = kPi * (random.uniform() - 0.5), tube = 2.0 * kPi * random.uniform();
      const double r = 0.5 + 0.08 * std::cos(tube);
      const Eigen::Vector3d x(0.6 + reach / 0.5 * r * std::cos(around), 0.08 * std::sin(tube), r * std::sin(around));
      handle.col(i) = x.cast<float>();
    }
    const Eigen::Isometry3d pose = randomPose(11);
    const Points cloud = moved(joined(cylinder(6000, 2).cloud(), handle), pose);
    const SymmetryFrame frame = symmetryFrame(cloud);
    EXPECT_LT(axisError(frame.axes, pose.linear()), 3.0 * kDegree) << reach;
    EXPECT_LT((frame.center - pose.translation()).norm(), 0.01 * approximateDiameter(cloud)) << reach;
    EXPECT_GT((centerOfMass(cloud) - pose.translation()).norm(), 0.03 * diagonal(cloud)) << reach;
  }
}

/// A box about the origin on stands, as the mailboxes of Figure 10: (middle, half sizes) of each.
Points mailbox(std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> stands) {
  constexpr double kPointsPerArea = 300.0;
  Points points(3, 0);
  stands.insert(stands.begin(), {Eigen::Vector3d::Zero(), {0.8, 1.5, 0.7}});
  for (const auto& [middle, half] : stands) {
    const double area = 8.0 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
    const Shape part = box(half, static_cast<int>(kPointsPerArea * area), Sampling::Random, 1 + points.cols());
    points = joined(points, part.cloud().colwise() + middle.cast<float>());
  }
  return points;
}

/// Figure 10: the stand moves neither the axes nor the center.
TEST(SymmetryFrame, OfAMailboxIsThatOfItsBox) {
  const double half = 0.12;
  const std::vector<Points> mailboxes{
      mailbox({{{0.0, 0.0, -1.5}, {half, half, 0.8}}}), mailbox({{{0.0, 1.0, -2.0}, {half, half, 1.3}}}),
      mailbox({{{0.0, -1.1, -1.65}, {half, half, 0.95}}, {{0.0, -1.1, -2.65}, {0.6, 0.6, 0.05}}})};
  FrameOptions options;
  options.probabilities = false;
  for (std::size_t i = 0; i < mailboxes.size(); ++i) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const Eigen::Isometry3d pose = randomPose(seed + 4 * i);
      const Points cloud = moved(mailboxes[i], pose);
      const SymmetryFrame frame = symmetryFrame(cloud, options);
      EXPECT_LT(axisError(frame.axes, pose.linear()), 1.5 * kDegree) << i << " " << seed;
      EXPECT_LT((frame.center - pose.translation()).norm(), 0.01 * approximateDiameter(cloud)) << i << " " << seed;
    }
  }
}

TEST(SymmetryFrame, OfAWholeCloudIsThatOfItsPlanes) {
  const Points points = box({1.0, 0.7, 0.4}, 8000, Sampling::Random, 3).cloud();
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Eigen::Isometry3d pose = randomPose(seed);
    const Points cloud = moved(points, pose);
    const SymmetryFrame frame = symmetryFrame(cloud);
    expectRightHanded(frame.axes);
    EXPECT_GT(frame.scores.minCoeff(), 0.85);
    EXPECT_EQ(frame.revolution_axis, -1);
    EXPECT_LT(axisError(frame.axes, pose.linear()), 0.5 * kDegree) << seed;
    EXPECT_LT((frame.center - pose.translation()).norm(), 0.002 * approximateDiameter(cloud)) << seed;
    EXPECT_LT((frame.T_canonical_input * frame.center).norm(), 1e-9) << seed;
    EXPECT_LT((frame.T_canonical_input.linear() * frame.axes - Eigen::Matrix3d::Identity()).norm(), 1e-9) << seed;
  }
}

TEST(SymmetryFrame, LiesOnThePlanesThatAreDecided) {
  const Points few = box({1.0, 0.7, 0.4}, 3000, Sampling::Random, 3).cloud();
  const SymmetryFrame frame = symmetryFrame(few);
  const Detection found = detectPlanes(few);
  ASSERT_EQ(found.planes.size(), 3u);
  for (const SymmetryPlane& plane : found.planes)
    EXPECT_LT(std::abs(plane.signedDistance(frame.center)), 1e-4 * approximateDiameter(few));
}

TEST(SymmetryFrame, OfAScanOfABodyOfRevolutionLiesOnItsAxis) {
  const Points cloud = cylinder(20'000, 1).cloud();  // of radius 0.6
  const Eigen::Vector3d scanner(5.0, 0.0, 3.0);
  const Points seen = pointsWhere(cloud, [](const Eigen::Vector3f& x) {
    return x.z() == 1.0f || (x.z() > -1.0f && 5.0f * x.x() > 0.36f && x.head<2>().norm() > 0.599f);
  });
  const Visibility visibility = *Visibility::fromPoints(seen, scanner);
  const SymmetryFrame frame = symmetryFrame(seen, {}, &visibility);
  ASSERT_GE(frame.revolution_axis, 0);
  EXPECT_GT(std::abs(frame.axes(2, frame.revolution_axis)), std::cos(0.5 * kDegree));
  EXPECT_LT(frame.center.head<2>().norm(), 0.005 * approximateDiameter(cloud));
}

TEST(SymmetryFrame, ListsTheFramesThatSymmetryLeavesEquallyGood) {
  // The frame itself is the first, all have its center at the origin, and all are rotations.
  const Eigen::Isometry3d pose = randomPose(2);
  const SymmetryFrame of_box = symmetryFrame(moved(finnedBox(8), pose));
  ASSERT_GE(of_box.equivalent.size(), 4u);
  EXPECT_EQ(of_box.equivalent[0].matrix(), of_box.T_canonical_input.matrix());
  for (const Eigen::Isometry3d& T : of_box.equivalent) EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-5);

  // Of a cube each of its 24 rotations is there.
  const SymmetryFrame frame = symmetryFrame(moved(cube(6000, Sampling::Random, 3), pose).cloud());
  ASSERT_LT(axisError(frame.axes, pose.linear()), 2.0 * kDegree) << "across faces, not edges: the surface agrees";
  EXPECT_GE(frame.equivalent.size(), 24u);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d rotated =
        frame.T_canonical_input.linear() * Eigen::AngleAxisd(0.5 * kPi, frame.axes.col(axis));
    EXPECT_TRUE(std::any_of(frame.equivalent.begin(), frame.equivalent.end(), [&](const auto& T) {
      return angleOf(T.linear() * rotated.transpose()) < 5.0 * kDegree;
    })) << axis;
  }
}

TEST(SymmetryFrame, ListsFramesThatMayBeTheShapesOwnWithTheirProbabilities) {
  const Eigen::Isometry3d pose = randomPose(4);
  const SymmetryFrame frame = symmetryFrame(moved(finnedBox(5), pose));
  ASSERT_GE(frame.probable.size(), 2u);
  EXPECT_EQ(frame.probable[0].axes, frame.axes) << "the frame itself is the first";
  EXPECT_EQ(frame.probable[0].center, frame.center);
  EXPECT_GT(frame.probable[0].probability, 0.5);
  double sum = 0.0;
  for (const ProbableFrame& other : frame.probable) {
    expectRightHanded(other.axes);
    EXPECT_GE(other.probability, 0.0);
    sum += other.probability;
  }
  EXPECT_LT(sum, 1.0) << "none of them may be right";
  for (std::size_t i = 2; i < frame.probable.size(); ++i)
    EXPECT_LE(frame.probable[i].probability, frame.probable[i - 1].probability);

  FrameOptions options;
  options.probabilities = false;
  const SymmetryFrame without = symmetryFrame(moved(finnedBox(5), pose), options);
  EXPECT_TRUE(without.probable.empty());
  EXPECT_EQ(without.T_canonical_input.matrix(), frame.T_canonical_input.matrix());
}

TEST(SymmetryFrame, FindsAxesOfRevolutionAndSpheres) {
  const Eigen::Isometry3d pose = randomPose(9);
  const SymmetryFrame round = symmetryFrame(moved(cylinder(8000, 1), pose).cloud());
  ASSERT_GE(round.revolution_axis, 0);
  ASSERT_LE(round.revolution_axis, 2);
  EXPECT_GT(std::abs(round.axes.col(round.revolution_axis).dot(pose.linear().col(2))), std::cos(2.0 * kDegree));
  EXPECT_LT((round.center - pose.translation()).norm(), 0.03);

  const SymmetryFrame ball = symmetryFrame(moved(sphere(6000, 1), pose).cloud());
  EXPECT_EQ(ball.revolution_axis, 3);
  EXPECT_LT((ball.center - pose.translation()).norm(), 0.03);
}

TEST(SymmetryFrame, OfAScanIsThatOfTheWhole) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1.0, 1.3, 0.8), Eigen::Vector3d(-1.2, 0.7, 1.0), Eigen::Vector3d(0.8, -1.0, -1.1)}) {
    const Scan scan = test::scan(blockBox(), 6.0 * direction.normalized());
    const Points cloud = scan.cloud();
    const Visibility visibility = scan.visibility();
    const SymmetryFrame frame = symmetryFrame(cloud, {}, &visibility);
    expectRightHanded(frame.axes);
    EXPECT_LT(axisError(frame.axes, Eigen::Matrix3d::Identity()), 2.0 * kDegree) << direction.transpose();
    const double diagonal = 2.0 * Eigen::Vector3d(1.0, 0.7, 0.45).norm();
    EXPECT_LT(frame.center.norm(), 0.04 * diagonal) << direction.transpose();
    EXPECT_GT(centerOfMass(cloud).norm(), 2.0 * frame.center.norm()) << direction.transpose();
  }
}

/// The box of blocks has half turns; from a corner one of them is confirmed by what was seen.
TEST(SymmetryFrame, OfAScanLiesOnThePlaneThatIsDecidedAndListsTurnsUnlessToldNotTo) {
  const Scan scan = test::scan(blockBox(), 6.0 * Eigen::Vector3d(1.0, 1.3, 0.8).normalized());
  const Points cloud = scan.cloud();
  const Visibility visibility = scan.visibility();
  const SymmetryFrame frame = symmetryFrame(cloud, {}, &visibility);
  const Detection found = detectPlanes({cloud, &visibility});
  ASSERT_FALSE(found.planes.empty());
  const SymmetryPlane& best = found.planes.front();
  ASSERT_EQ(best.kind, PlaneKind::Symmetry);
  EXPECT_GT((frame.axes.transpose() * best.normal()).cwiseAbs().maxCoeff(), std::cos(0.2 * kDegree));
  EXPECT_LT(std::abs(best.signedDistance(frame.center)), 2e-3 * approximateDiameter(cloud));
  for (std::size_t i = 0; i < frame.rotations.size(); ++i) {
    EXPECT_GE(frame.rotations[i].confidence, DetectionOptions().min_possible);
    EXPECT_LE(frame.rotations[i].confidence, i == 0 ? 1.0 : frame.rotations[i - 1].confidence);
    EXPECT_NEAR(frame.rotations[i].direction.norm(), 1.0, 1e-9);
    EXPECT_EQ(frame.rotations[i].fold % 2, 0) << "a box has no other turns";
  }
  FrameOptions options;
  options.rotations = false;
  EXPECT_TRUE(symmetryFrame(cloud, options, &visibility).rotations.empty());
  expectSame(symmetryFrame(cloud, options, &visibility), frame);
  EXPECT_TRUE(symmetryFrame(cloud).rotations.empty()) << "whole objects have objectSymmetries()";
}

TEST(SymmetryFrame, IsTheSameForAnyNumberOfThreads) {
  const Scan scan = test::scan(blockChair(), {3.0, -4.0, 3.5});
  const Points cloud = scan.cloud();
  const Visibility visibility = scan.visibility();
  for (const Visibility* const seen : {&visibility, static_cast<const Visibility*>(nullptr)}) {
    const auto frame = [&](int num_threads) {
      FrameOptions options;
      options.num_threads = num_threads;
      return symmetryFrame(cloud, options, seen);
    };
    compareThreads(frame, [](const SymmetryFrame& many, const SymmetryFrame& one) {
      expectSame(many, one);
      EXPECT_EQ(valuesOf(many.rotations, &SymmetryRotation::point, &SymmetryRotation::confidence),
                valuesOf(one.rotations, &SymmetryRotation::point, &SymmetryRotation::confidence));
    });
  }
}

TEST(SymmetryFrame, AsPublishedFindsTheAxesOfABox) {
  FrameOptions options;
  options.as_published = true;
  const Eigen::Isometry3d pose = randomPose(4);
  const auto shape = moved(box(6000, Sampling::Random, 4), pose);
  const SymmetryFrame frame = symmetryFrame(shape.cloud(), options);
  expectRightHanded(frame.axes);
  EXPECT_LT(axisError(frame.axes, pose.linear()), 4.0 * kDegree) << "as fine as the bins of the map";
  EXPECT_LT((frame.center - pose.translation()).norm(), 0.05);
  EXPECT_EQ(frame.equivalent.size(), 4u);
}

TEST(SymmetryFrame, OfDegeneratePointsIsFiniteOrRefused) {
  RandomStream random(1);
  Points line(3, 100), two(3, 2);
  for (Eigen::Index i = 0; i < line.cols(); ++i) line.col(i) = random.uniform() * Eigen::Vector3f(1.0f, 2.0f, 3.0f);
  two << 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 2.0f;
  for (const Points& points : {line, flatSquare(400, 1), two}) {
    const SymmetryFrame frame = symmetryFrame(points);
    expectRightHanded(frame.axes);
    EXPECT_TRUE(frame.scores.allFinite());
    const BoundingBall ball = boundingBall(points);
    EXPECT_LE((frame.center - ball.center).norm(), 1.1 * ball.radius);
  }
  EXPECT_THROW(symmetryFrame(Points::Ones(3, 20)), std::invalid_argument);
  EXPECT_THROW(symmetryFrame(Points(3, 0)), std::invalid_argument);
}

TEST(FrameOptions, NamesFieldValueAndRule) {
  FrameOptions options;
  options.num_phi = 3;
  EXPECT_EQ(complaintOf<std::invalid_argument>([&] { options.validate(); }),
            "num_phi = 3, must be even and in [2, 4096]");
}

FrameCandidate candidate(const Eigen::Matrix3d& axes, const Eigen::Vector3f& scores) {
  FrameCandidate frame;
  frame.axes = axes.cast<float>();
  frame.offsets.setZero();
  frame.scores = scores;
  return frame;
}

TEST(MeanCenter, LiesBetweenFramesThatAreNearlyAsGood) {
  std::vector<FrameCandidate> frames(3, candidate(Eigen::Matrix3d::Identity(), Eigen::Vector3f::Ones()));
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].value = 2.0 - (i == 2 ? 1.0 : 0.0);
  const std::vector<Eigen::Vector3d> centers{Eigen::Vector3d::Zero(), Eigen::Vector3d(2, 4, 6),
                                             Eigen::Vector3d(100, 0, 0)};
  EXPECT_LT((meanCenter(centers, frames) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6) << "the third is far worse";
  EXPECT_EQ(meanCenter({centers[1]}, {frames[1]}), centers[1]);
}

TEST(CenterOfSymmetry, AcrossNoSymmetryIsTheMiddleOfTheExtent) {
  // A cone: its profile along the axis of z has no peak.
  Points cloud(3, 6000);
  RandomStream random(3);
  for (Eigen::Index i = 0; i < cloud.cols(); ++i) {
    const double r = std::sqrt(random.uniform()), angle = 2.0 * kPi * random.uniform();
    cloud.col(i) = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 2.0 - 2.0 * r).cast<float>();
  }
  const PointsRef points(cloud);
  const FrameEvidence evidence(points, FrameOptions(), nullptr);
  const Eigen::Vector3d center =
      centerOfSymmetry(evidence, candidate(Eigen::Matrix3d::Identity(), Eigen::Vector3f::Ones()));
  EXPECT_LT(center.head<2>().norm(), 0.01 * approximateDiameter(points));
  EXPECT_LT(std::abs(center.z() - 1.0), 0.2) << "between tip and rim";
}

TEST(EquivalentFrames, HaveEveryOrderOfAxesWhoseScoresTie) {
  const auto count = [](const Eigen::Vector3f& scores) {
    std::vector<Eigen::Isometry3d> poses;
    addTied(candidate(randomPose(3).linear(), scores), scores, Eigen::Vector3d::Zero(), poses);
    return poses.size();
  };
  EXPECT_EQ(count({0.9f, 0.7f, 0.5f}), 4u) << "signs only";
  EXPECT_EQ(count({0.9f, 0.55f, 0.5f}), 8u) << "two orders";
  EXPECT_EQ(count({0.9f, 0.88f, 0.86f}), 24u) << "all orders";
}

TEST(EquivalentFrames, LeaveOutFramesThatScoreLess) {
  const Eigen::Vector3f best(0.9f, 0.7f, 0.5f);
  std::vector<Eigen::Isometry3d> poses;
  addTied(candidate(randomPose(4).linear(), {0.9f, 0.7f, 0.4f}), best, Eigen::Vector3d::Zero(), poses);
  EXPECT_TRUE(poses.empty());
  addTied(candidate(randomPose(4).linear(), {0.5f, 0.9f, 0.7f}), best, Eigen::Vector3d::Zero(), poses);
  EXPECT_EQ(poses.size(), 4u) << "in the order that scores enough";
}

TEST(RotationsAboutRevolution, AreNotListed) {
  const Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();
  const Eigen::Matrix3f rotated = Eigen::AngleAxisf(0.7f, Eigen::Vector3f::UnitY()).toRotationMatrix();
  const Eigen::Matrix3f tilted = Eigen::AngleAxisf(0.7f, Eigen::Vector3f::Ones().normalized()).toRotationMatrix();
  EXPECT_FALSE(isRotatedAboutRevolution(axes, -1, rotated));
  EXPECT_TRUE(isRotatedAboutRevolution(axes, 1, rotated));
  EXPECT_FALSE(isRotatedAboutRevolution(axes, 1, tilted));
  EXPECT_TRUE(isRotatedAboutRevolution(axes, 3, tilted));
}

FrameChoice choiceWith(double value) {
  FrameChoice choice;
  choice.terms[0] = 1.0;
  choice.terms[1] = value;
  return choice;
}

TEST(FrameProbabilities, AreThoseOfTheConditionalLogit) {
  FrameTerms weights = FrameTerms::Zero();
  weights.head<2>() << 0.5, 2.0;
  const std::vector<double> p = frameProbabilities({choiceWith(0.0), choiceWith(-1.0)}, weights);
  ASSERT_EQ(p.size(), 2u);
  const double a = std::exp(0.5), b = std::exp(-1.5);
  EXPECT_NEAR(p[0], a / (1.0 + a + b), 1e-12);
  EXPECT_NEAR(p[1], b / (1.0 + a + b), 1e-12);
  EXPECT_TRUE(frameProbabilities({}, weights).empty());
}

TEST(FrameProbabilities, StayFiniteForAnyWeight) {
  FrameTerms weights = FrameTerms::Zero();
  for (const double weight : {-1e4, 1e4}) {
    weights[0] = weight;
    const double p = frameProbabilities({choiceWith(0.0)}, weights)[0];
    EXPECT_NEAR(p, weight > 0.0 ? 1.0 : 0.0, 1e-12);
  }
}

TEST(ProbableFrames, AreEachThereOnce) {
  // A slanted box: its first plane is x = 0; seen along x it is a parallelogram, which people may put on either side.
  Shape shape = box({0.3, 0.5, 1.0}, 6000, Sampling::Random, 3);
  shape.points.row(1) += 0.4 * shape.points.row(2);
  const std::vector<ProbableFrame> frames = symmetryFrame(moved(shape, randomPose(8)).cloud()).probable;
  ASSERT_GE(frames.size(), 2u);
  EXPECT_EQ(frames.front().evidence[5], 1.0);
  // One of them stands on the longer side of the parallelogram, which was y = const.
  const Eigen::Vector3d up = randomPose(8).linear() * Eigen::Vector3d(0.0, 1.0, -0.4).normalized();
  double level = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_LE(frames[i].evidence[1], 0.0) << "no value above the best";
    level = std::max(level, (frames[i].axes.transpose() * up).cwiseAbs().maxCoeff());
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Matrix3d cosines = (frames[i].axes.transpose() * frames[j].axes).cwiseAbs();
      EXPECT_LT(cosines.rowwise().maxCoeff().minCoeff(), std::cos(2.5 * kDegree)) << i << " " << j;
    }
  }
  EXPECT_GT(level, std::cos(3.0 * kDegree));
}

/// Two opposite quarters of a box: no plane across x maps them onto each other, but it does once the cloud is completed
/// across y.
TEST(PlaneProfiles, CompletedCloudsHaveTheSymmetryOfTheWhole) {
  const Points whole = box(12'000, Sampling::Mirrored, 2).cloud();
  const Points quarters = pointsWhere(whole, [](const Eigen::Vector3f& x) { return x.x() * x.y() > 0.0f; });
  GaussianEdtOptions options;
  options.radius = boundingBall(whole).radius;
  const PlaneProfiles profiles(GaussianEdt(quarters, options), {}, 256, 1, 1);
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const CellPlane across_y{Eigen::Vector3f::UnitY(), 0.0f};
  EXPECT_LT(profiles.score({x, 0.0f}), 0.4f);
  EXPECT_GT(profiles.scores(x, 0.0f, 0.0f, 1, &across_y)[0], 0.9f);
}

/// A house seen along y: 4 wide along x, 2 high up to its eaves and 3 up to its ridge.
Points house() {
  Points points(3, 6);
  points << -2, 2, 2, 0, -2, 0,  //
      0, 1, 0, 1, 0, 0,          //
      0, 0, 2, 3, 2, 1;
  return points;
}

TEST(Outline, HasTheBoxAndTheContactOfItsCorners) {
  const Outline outline(house(), Eigen::Vector3f::UnitY());
  const Outline::Box upright = outline.boxAt(outline.angleOf(Eigen::Vector3f::UnitX()));
  EXPECT_NEAR(upright.area, 12.0, 1e-4) << "4 x 3";
  EXPECT_NEAR(upright.contact, 1.0, 1e-4) << "it stands on its longer side";
  const Outline::Box tilted = outline.boxAt(outline.angleOf(Eigen::Vector3f(1.0f, 0.0f, 0.3f)));
  EXPECT_GT(tilted.area, upright.area);
  EXPECT_LT(tilted.contact, 0.1) << "it stands on a corner";
}

TEST(Outline, OfPointsWithoutExtentHasNoContact) {
  for (const int count : {1, 3}) {
    const Outline::Box box = Outline(Points::Zero(3, count), Eigen::Vector3f::UnitZ()).boxAt(0.3);
    EXPECT_EQ(box.area, 0.0);
    EXPECT_EQ(box.contact, 0.0);
  }
}

}  // namespace
}  // namespace pcl_symmetry
