#include "pcl_symmetry/symmetry_registration.h"

#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/registration/icp.h>

#include <cmath>
#include <set>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/base/symmetric_solvers.h"
#include "pcl/clouds.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

template <typename PointT = pcl::PointXYZ>
using CloudPtr = typename pcl::PointCloud<PointT>::Ptr;

/// A scan of the chair, which has no rotation of its own, moved by \p pose; it says where the scanner stood.
template <typename PointT = pcl::PointXYZ>
CloudPtr<PointT> chairScan(const Eigen::Isometry3d& pose) {
  const Scan scan = test::scan(blockChair(), {3.0, -6.0, 4.0});
  const auto cloud = toCloud<PointT>(moved(scan.cloud(), pose));
  cloud->sensor_origin_.template head<3>() = (pose * scan.viewpoint).cast<float>();
  return cloud;
}

CloudPtr<> chairModel() {
  return toCloud(surfaceOf(blockChair(), 6000));
}

double angleOf(const Eigen::Matrix4f& transform) {
  return test::angleOf(transform.topLeftCorner<3, 3>().cast<double>());
}

class SymmetryRegistrationTest : public testing::Test {
protected:
  void SetUp() override {
    level_ = pcl::console::getVerbosityLevel();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  void TearDown() override { pcl::console::setVerbosityLevel(level_); }

  /// \return whether it converges.
  bool alignFrom(const Eigen::Isometry3d& guess) {
    registration_.align(aligned_, guess.matrix().cast<float>());
    return registration_.hasConverged();
  }
  bool align(const CloudPtr<>& source, const CloudPtr<>& target) {
    registration_.setInputSource(source);
    registration_.setInputTarget(target);
    return alignFrom(Eigen::Isometry3d::Identity());
  }

  /// Radians by which the answer is off where the source is the target moved by \p pose.
  double angleOff(const Eigen::Isometry3d& pose) {
    return angleOf(registration_.getFinalTransformation() * pose.matrix().cast<float>());
  }

  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration_;
  pcl::PointCloud<pcl::PointXYZ> aligned_;

private:
  pcl::console::VERBOSITY_LEVEL level_;
};

/// What a caller of pcl::Registration sees.
struct UserAnswer {
  bool converged;
  Eigen::Matrix4f transform;
  double fitness;
  std::size_t num_aligned;
};

UserAnswer alignAsAUserDoes(const pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>::Ptr& registration,
                            const CloudPtr<>& source, const CloudPtr<>& target) {
  registration->setInputSource(source);
  registration->setInputTarget(target);
  registration->setMaximumIterations(40);
  registration->setMaxCorrespondenceDistance(0.3);
  registration->setTransformationEpsilon(1e-9);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration->align(aligned);
  const double fitness = registration->getFitnessScore();
  return {registration->hasConverged(), registration->getFinalTransformation(), fitness, aligned.size()};
}

TEST_F(SymmetryRegistrationTest, StandsWhereAnyRegistrationOfPCLStands) {
  const Eigen::Isometry3d pose = randomPose(3);
  const auto scan = chairScan(pose), model = chairModel();
  const UserAnswer theirs =
      alignAsAUserDoes(pcl::make_shared<pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>(), scan, model);
  const UserAnswer ours =
      alignAsAUserDoes(pcl::make_shared<SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ>>(), scan, model);
  EXPECT_TRUE(ours.converged);
  EXPECT_LT(angleOf(ours.transform * pose.matrix().cast<float>()), 2.0 * kDegree);
  EXPECT_LT((ours.transform * pose.matrix().cast<float>()).topRightCorner(3, 1).norm(), 0.03);
  EXPECT_LT(ours.fitness, 0.03 * 0.03);
  EXPECT_EQ(ours.num_aligned, theirs.num_aligned);
  EXPECT_GT(angleOf(theirs.transform * pose.matrix().cast<float>()), 5.0 * kDegree) << "or the pose was too easy";
}

TEST_F(SymmetryRegistrationTest, MeasuresTheFitOfPointsThatAreThere) {
  const auto scan = chairScan(randomPose(3)), with_gaps = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*scan);
  const float none = std::numeric_limits<float>::quiet_NaN();
  const auto model = chairModel();
  for (const auto& cloud : {with_gaps, model}) {
    for (int i = 0; i < 100; ++i) cloud->push_back(pcl::PointXYZ(none, none, none));
    cloud->is_dense = false;
  }
  align(scan, model);
  const double expected = registration_.getFitnessScore();
  EXPECT_LT(expected, 0.03 * 0.03);
  EXPECT_LT(registration_.getFitnessScore(0.5 * expected), 0.5 * expected);
  ASSERT_TRUE(align(with_gaps, model));
  pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>& as_any = registration_;
  EXPECT_NEAR(as_any.getFitnessScore(), expected, 0.05 * expected);
}

TEST_F(SymmetryRegistrationTest, BringsWholesTogetherInDoublesAndTurnsNormals) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d pose = randomPose(2);
  const auto source = toCloud<pcl::PointNormal>(moved(shape, pose));
  for (pcl::PointNormal& point : *source) point.getNormalVector3fMap() = Eigen::Vector3f::UnitX();
  SymmetryRegistration<pcl::PointNormal, pcl::PointNormal, double> registration;
  registration.setInputSource(source);
  registration.setInputTarget(toCloud<pcl::PointNormal>(asymmetricBlob(4000, 2)));
  pcl::PointCloud<pcl::PointNormal> aligned;
  registration.align(aligned);
  ASSERT_TRUE(registration.hasConverged());
  const Eigen::Matrix4d error = registration.getFinalTransformation() * pose.matrix();
  EXPECT_LT(angleOf(error.cast<float>()), 1.0 * kDegree);
  EXPECT_LT(
      (aligned[0].getNormalVector3fMap() - registration.getFinalTransformation().topLeftCorner<3, 1>().cast<float>())
          .norm(),
      1e-5);
}

TEST_F(SymmetryRegistrationTest, TakesTheGuessAndIndices) {
  // A scan of something else beside the chair is left out by the indices.
  const Eigen::Isometry3d pose = randomPose(5);
  const auto scan = chairScan(pose);
  const std::size_t size = scan->size();
  for (int i = 0; i < 1000; ++i) scan->push_back(pcl::PointXYZ(9.0f + 0.01f * i, 1.0f, 2.0f));
  auto indices = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < size; ++i) indices->push_back(static_cast<pcl::index_t>(i));
  registration_.setSearchAround(0.2, 0.2);
  registration_.setInputSource(scan);
  registration_.setIndices(indices);
  registration_.setInputTarget(chairModel());
  ASSERT_TRUE(alignFrom(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) * pose.inverse()))
      << "the guess alone leads there";
  EXPECT_LT(angleOff(pose), 2.0 * kDegree);
  EXPECT_EQ(aligned_.size(), size);
}

/// The motion from one frame of a track to the next, about the middle of the chair.
Eigen::Isometry3d motion(double angle, double distance) {
  const Eigen::Vector3d along = Eigen::Vector3d(2.0, -1.0, 0.5).normalized();
  return Eigen::Translation3d(distance * along) * Eigen::AngleAxisd(angle, along.unitOrthogonal());
}

TEST_F(SymmetryRegistrationTest, TracksAroundTheGuess) {
  const Eigen::Isometry3d pose = randomPose(7);
  registration_.setInputSource(chairScan(pose));
  const auto model = chairModel();
  registration_.setInputTarget(model);
  const double size = diagonal(model->getMatrixXfMap(3, 4, 0));
  registration_.setSearchAround(25.0 * kDegree, 0.4 * size);
  ASSERT_TRUE(alignFrom(motion(15.0 * kDegree, 0.1 * size) * pose.inverse())) << registration_.getReason();
  EXPECT_LT(angleOff(pose), 2.0 * kDegree);
  for (const auto& [stage, time] : registration_.getTiming()) EXPECT_NE(stage, "frames");

  registration_.setSearchAround(5.0 * kDegree, 0.4 * size);
  EXPECT_FALSE(alignFrom(motion(60.0 * kDegree, 0.0) * pose.inverse())) << "the true pose is farther away";
  EXPECT_EQ(registration_.getReason().rfind("nothing fits around the guess", 0), 0u) << registration_.getReason();
}

/// Of a box with three half turns only the pose next to the last frame is right for a track.
TEST_F(SymmetryRegistrationTest, TracksDoNotFlip) {
  const auto cloud = toCloud(box(4000, Sampling::Random, 1));
  registration_.setInputSource(cloud);
  registration_.setInputTarget(cloud);
  registration_.setSearchAround(40.0 * kDegree, 10.0);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Isometry3d half_turn(Eigen::AngleAxisd(kPi, Eigen::Vector3d::Unit(k)));
    ASSERT_TRUE(alignFrom(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()) * half_turn))
        << registration_.getReason();
    EXPECT_LT(angleOff(half_turn), 3.0 * kDegree);
  }
}

TEST_F(SymmetryRegistrationTest, ListsThePosesThatSymmetryMakesEqual) {
  ASSERT_TRUE(align(toCloud(box(4000, Sampling::Random, 1)), toCloud(box(4000, Sampling::Random, 2))));
  const std::vector<RegisteredPose>& poses = registration_.getPoses();
  ASSERT_EQ(poses.size(), 4u) << "the identity and three half turns";
  EXPECT_TRUE(poses[0].T_target_source.matrix().cast<float>().isApprox(registration_.getFinalTransformation()));
  EXPECT_EQ(poses[0].score.merit(), registration_.getScore().merit());
  std::set<int> turns;
  for (const RegisteredPose& pose : poses) {
    const Eigen::Vector3d signs = pose.T_target_source.linear().diagonal();
    EXPECT_GT(signs.cwiseAbs().minCoeff(), std::cos(5.0 * kDegree));
    turns.insert((signs.x() > 0 ? 1 : 0) + (signs.y() > 0 ? 2 : 0) + (signs.z() > 0 ? 4 : 0));
    EXPECT_GT(pose.score.merit(), poses[0].score.merit() - 0.15);
  }
  EXPECT_EQ(turns, (std::set<int>{1, 2, 4, 7}));
}

TEST_F(SymmetryRegistrationTest, SaysWhereNothingFits) {
  const auto fails = [&](const CloudPtr<>& source, const CloudPtr<>& target) {
    EXPECT_FALSE(align(source, target));
    EXPECT_EQ(registration_.getFinalTransformation(), Eigen::Matrix4f::Identity());
    ASSERT_EQ(aligned_.size(), source->size());
    EXPECT_EQ(aligned_[0].x, (*source)[0].x) << "the source as it was";
    EXPECT_NE(registration_.getReason(), "");
  };
  const auto chair = chairScan(randomPose(1)), model = chairModel();
  fails(chair, toCloud(sphere(4000, 1)));
  EXPECT_LT(registration_.getScore().merit(), 0.4);
  EXPECT_EQ(registration_.getReason().rfind("nothing fits", 0), 0u);
  EXPECT_NE(registration_.getReason().find("of the source lie on the target"), std::string::npos);
  fails(toCloud(Points::Ones(3, 5)), model);
  fails(chair, toCloud(Points::Ones(3, 1)));
  EXPECT_EQ(registration_.getReason().rfind("target: ", 0), 0u);
  fails(toCloud(Points::Random(3, 19)), model);
  EXPECT_EQ(registration_.getReason().rfind("source: ", 0), 0u);
  EXPECT_EQ(registration_.getScore().support, 0.0) << "that of the last pair is gone";
}

/// A box with a knob at its back. From the front, the half turn that brings back to back cannot be told from none,
/// unless the scanner looks over the box and sees the top of the knob.
TEST_F(SymmetryRegistrationTest, RefusesAPoseBesideWhichAnotherOneFitsAsWell) {
  const auto alignFrom = [&](const Eigen::Vector3d& viewpoint, double height_of_knob) {
    BlockObject box = blockBox();
    box.blocks.push_back({{0.5, -1.0, height_of_knob}, {0.3, 0.3, 0.1}});
    const auto cloud = toCloud(test::scan(box, viewpoint).cloud());
    cloud->sensor_origin_.head<3>() = viewpoint.cast<float>();
    return align(cloud, toCloud(surfaceOf(box, 6000)));
  };
  EXPECT_FALSE(alignFrom({3.0, 6.0, 4.0}, 0.0));
  EXPECT_LT(registration_.getEvidence().uniqueness, 0.8);
  EXPECT_EQ(registration_.getReason().rfind("another pose fits as well", 0), 0u) << registration_.getReason();
  EXPECT_TRUE(alignFrom({3.0, 6.0, 4.0}, 0.2)) << registration_.getReason();
  EXPECT_LT(angleOf(registration_.getFinalTransformation()), 2.0 * kDegree);
  EXPECT_TRUE(alignFrom({3.0, -6.0, 4.0}, 0.2)) << registration_.getReason();
  EXPECT_GT(registration_.getEvidence().uniqueness, 0.9);
  EXPECT_LT(angleOf(registration_.getFinalTransformation()), 2.0 * kDegree);
}

TEST_F(SymmetryRegistrationTest, SaysWhyItDidNotBegin) {
  EXPECT_EQ(registration_.getReason(), "source: not set");
  const auto chair = chairScan(randomPose(1)), model = chairModel();
  registration_.setInputSource(chair);
  EXPECT_EQ(registration_.getReason(), "target: not set");
  registration_.align(aligned_);
  EXPECT_EQ(registration_.getReason(), "target: not set");
  registration_.setInputTarget(model);
  EXPECT_EQ(registration_.getReason(), "align() was not called with these clouds");
  registration_.setIndices(pcl::make_shared<pcl::Indices>());
  registration_.align(aligned_);
  EXPECT_EQ(registration_.getReason(), "source: the indices are empty");
}

template <typename PointT>
Eigen::Matrix4f registered(const Shape& source, const Shape& target) {
  const auto of = [](const Shape& shape, auto& cloud) {
    pcl::copyPointCloud(*toCloud(shape), cloud);
    return cloud.makeShared();
  };
  SymmetryRegistration<PointT, PointT> registration;
  pcl::PointCloud<PointT> aligned, points, model;
  registration.setInputSource(of(source, points));
  registration.setInputTarget(of(target, model));
  registration.setSearchAround(0.2, 0.2);
  registration.align(aligned);
  EXPECT_TRUE(registration.hasConverged()) << registration.getReason();
  return registration.getFinalTransformation();
}

TEST_F(SymmetryRegistrationTest, TakesAnyPointType) {
  const Shape blob = asymmetricBlob(400, 1), model = asymmetricBlob(2000, 2);
  const Eigen::Matrix4f pose = registered<pcl::PointXYZ>(blob, model);
  EXPECT_EQ(registered<pcl::PointXYZL>(blob, model), pose);
  EXPECT_EQ(registered<pcl::PointXYZINormal>(blob, model), pose);
  EXPECT_EQ(registered<pcl::PointSurfel>(blob, model), pose);
  EXPECT_EQ(registered<pcl::PointWithViewpoint>(blob, model), pose);
  EXPECT_EQ(registered<pcl::InterestPoint>(blob, model), pose);
}

/// So few points fit any object at the distance that they are apart.
TEST_F(SymmetryRegistrationTest, TooFewPointsDoNotConvergeOnAnotherObject) {
  testing::internal::CaptureStderr();
  const auto converges = [&](const Shape& source, const Shape& target) {
    return align(toCloud(moved(source, randomPose(4))), toCloud(target));
  };
  const auto chair = [](int size) { return Shape{surfaceOf(blockChair(), size).cast<double>(), {}}; };
  for (const int size : {100, 400}) {
    EXPECT_FALSE(converges(asymmetricBlob(size, 1), chair(size))) << size;
    EXPECT_FALSE(converges(asymmetricBlob(size, 1), chair(6000))) << size;
  }
  EXPECT_TRUE(converges(asymmetricBlob(400, 1), asymmetricBlob(4000, 2)));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "PCL's ICP has nothing to say";
}

TEST_F(SymmetryRegistrationTest, PreparesTheTargetOnce) {
  const auto model = chairModel();
  const Eigen::Isometry3d pose = randomPose(7);
  const auto scan = chairScan(pose);
  registration_.setSearchAround(25.0 * kDegree, 0.5);
  registration_.setInputTarget(model);
  registration_.setInputSource(scan);
  const auto converges = [&] { return alignFrom(motion(0.1, 0.05) * pose.inverse()); };
  ASSERT_TRUE(converges());
  const Eigen::Matrix4f first = registration_.getFinalTransformation();
  // What becomes of the points after the first align() does not count until the target is set again.
  const pcl::PointCloud<pcl::PointXYZ> before = *model;
  for (pcl::PointXYZ& point : *model) point.getVector3fMap().setConstant(1.0f);
  EXPECT_TRUE(converges());
  EXPECT_EQ(registration_.getFinalTransformation(), first);
  registration_.setInputTarget(model);
  EXPECT_FALSE(converges());
  EXPECT_EQ(registration_.getReason().rfind("target: ", 0), 0u) << registration_.getReason();
  *model = before;
  registration_.setInputTarget(model);
  EXPECT_TRUE(converges());
  EXPECT_EQ(registration_.getFinalTransformation(), first);
  // What the target is prepared with counts at once.
  for (pcl::PointXYZ& point : *model) point.getVector3fMap().setConstant(1.0f);
  registration_.setRandomSeed(2);
  EXPECT_FALSE(converges());
}

TEST_F(SymmetryRegistrationTest, GivesACovarianceWhereItConverges) {
  const Eigen::Isometry3d pose = randomPose(7);
  const auto scan = chairScan(pose), model = chairModel();
  registration_.setSearchAround(0.2, 0.2);
  const auto deviations = [&](const CloudPtr<>& source, const CloudPtr<>& target, const Eigen::Isometry3d& guess) {
    registration_.setInputSource(source);
    registration_.setInputTarget(target);
    EXPECT_TRUE(alignFrom(guess));
    const Eigen::Matrix<double, 6, 6> covariance = registration_.getCovariance().value();
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(covariance).info(), Eigen::Success) << "positive definite";
    return covariance.diagonal().cwiseSqrt().eval();
  };
  // The residuals of an exact scan are those of tangent planes between points: less than a spacing of 0.03.
  for (const bool swapped : {false, true}) {
    const auto found = swapped ? deviations(model, scan, pose) : deviations(scan, model, pose.inverse());
    EXPECT_LT(found.maxCoeff(), 0.03) << swapped;
    EXPECT_GT(found.minCoeff(), 1e-6) << swapped;
  }
  EXPECT_FALSE(align(model, toCloud(sphere(4000, 1))));
  EXPECT_FALSE(registration_.getCovariance());
  EXPECT_FALSE(registration_.getPoses().empty());
  // Nothing fixes how a sphere is turned.
  const auto open = deviations(toCloud(sphere(4000, 1)), toCloud(sphere(4000, 2)), Eigen::Isometry3d::Identity());
  EXPECT_GT(open.head<3>().minCoeff(), 0.5);
  EXPECT_LT(open.tail<3>().maxCoeff(), 0.03);
}

TEST_F(SymmetryRegistrationTest, DoesNotDependOnThreadsAndUnits) {
  const Eigen::Isometry3d pose = randomPose(7);
  const auto scan = chairScan(pose), model = chairModel();
  const auto transform = [&] {
    EXPECT_TRUE(align(scan, model));
    return Eigen::Matrix4f(registration_.getFinalTransformation());
  };
  registration_.setNumberOfThreads(1);
  const Eigen::Matrix4f expected = transform();
  registration_.setNumberOfThreads(4);
  EXPECT_EQ(transform(), expected);
  constexpr float kMillimeters = 1000.0f;
  for (const auto& cloud : {scan, model}) {
    for (pcl::PointXYZ& point : *cloud) point.getVector3fMap() *= kMillimeters;
    cloud->sensor_origin_.head<3>() *= kMillimeters;
  }
  const Eigen::Matrix4f scaled = transform();
  EXPECT_LT(angleOf(scaled * expected.inverse()), 1.0 * kDegree);
  EXPECT_LT((scaled.topRightCorner<3, 1>() / kMillimeters - expected.topRightCorner<3, 1>()).norm(), 0.02);
}

TEST_F(SymmetryRegistrationTest, RefusesWrongParameters) {
  EXPECT_EQ(messageOf([&] { registration_.setMinConfidence(1.5); }), "min_confidence = 1.5, must be in [0, 1]");
  EXPECT_EQ(messageOf([&] { registration_.setMaxPoints(2); }), "max_points = 2, must be >= 3");
  EXPECT_EQ(messageOf([&] { registration_.setNumberOfThreads(-1); }), "num_threads = -1, must be >= 0");
  EXPECT_EQ(messageOf([&] { registration_.setSearchAround(0.0, 1.0); }), "around.angle = 0, must be in (0, pi]");
  EXPECT_EQ(messageOf([&] { registration_.setSearchAround(0.1, -1.0); }), "around.distance = -1, must be >= 0");
  registration_.setInputSource(chairModel());
  registration_.setInputTarget(chairModel());
  registration_.setSourceViewpoint({Viewpoint::Mode::Given, Eigen::Vector3d::Zero()});
  EXPECT_THROW(registration_.align(aligned_), pcl::BadArgumentException) << "among the points";
}

/// Points on a box of 4 x 3 x 2, and on a block on its top that leaves it no symmetry.
Points blockOnBox(std::uint64_t seed) {
  RandomStream random(seed);
  Points points(3, 3000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const bool block = i % 4 == 0;
    const Eigen::Vector3d low = block ? Eigen::Vector3d(0.6, 0.3, 1.0) : Eigen::Vector3d(-2.0, -1.5, -1.0);
    const Eigen::Vector3d high = block ? Eigen::Vector3d(1.6, 1.2, 1.8) : Eigen::Vector3d(2.0, 1.5, 1.0);
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = low[k] + random.uniform() * (high[k] - low[k]);
    const auto face = random.below(6);
    x[face / 2] = face % 2 ? high[face / 2] : low[face / 2];
    points.col(i) = x.cast<float>();
  }
  return points;
}

/// Errors of poses as small motions (w, t) of the target's frame, and the covariances that were said of them.
struct PoseErrors {
  Matrix6d scatter = Matrix6d::Zero(), said = Matrix6d::Zero();
  double mean_sq_distance = 0.0;  ///< Mahalanobis
};

/// Registers noisy samplings of one surface, each with its own noise. The target is far from the origin.
PoseErrors errorsUnderNoise(double noise, int num_trials) {
  const Eigen::Isometry3d T_target_source =
      Eigen::Translation3d(9.0, -4.0, 6.0) * Eigen::AngleAxisd(1.2, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
  PoseErrors errors;
  CloudRegistrationOptions options;
  options.around = PoseNeighborhood{20.0 * kDegree, 1.0};
  for (int i = 0; i < num_trials; ++i) {
    RandomStream random(100 + i);
    Points source = blockOnBox(10 + i), target = moved(blockOnBox(500 + i), T_target_source);
    for (Points* points : {&source, &target})
      for (Eigen::Index k = 0; k < points->size(); ++k)
        points->data()[k] += static_cast<float>(noise * gaussian(random));
    const CloudRegistration found =
        registerClouds(source, std::nullopt, target, std::nullopt, T_target_source, options);
    const Eigen::Isometry3d error = T_target_source * found.T_target_source.inverse();
    const Eigen::AngleAxisd turn(error.linear());
    Vector6d motion;
    motion << turn.angle() * turn.axis(), error.translation();
    errors.scatter += motion * motion.transpose() / num_trials;
    errors.said += *found.covariance / num_trials;
    errors.mean_sq_distance += motion.dot(solveSymmetric(*found.covariance, motion)) / num_trials;
  }
  return errors;
}

/// 30 trials know a standard deviation to 13 %.
TEST(RegisterClouds, SaysHowUncertainThePoseIs) {
  const PoseErrors errors = errorsUnderNoise(0.02, 30);
  for (int k = 0; k < 6; ++k) {
    const double ratio = std::sqrt(errors.said(k, k) / errors.scatter(k, k));
    EXPECT_GT(ratio, 0.7) << k;
    EXPECT_LT(ratio, 1.4) << k;
  }
  // Of a chi-squared variable with six degrees of freedom the mean is 6.
  EXPECT_GT(errors.mean_sq_distance, 6.0 / 2.0);
  EXPECT_LT(errors.mean_sq_distance, 6.0 * 2.0);
}

TEST(RegisterClouds, WhatOneScanShowsAloneDoesNotPull) {
  const Scan from_left = test::scan(blockChair(), {3.0, -6.0, 4.0}),
             from_right = test::scan(blockChair(), {-3.0, -6.0, 4.0});
  const auto degreesOff = [&](bool refine_closely) {
    CloudRegistrationOptions options;
    options.refine_closely = refine_closely;
    options.around = PoseNeighborhood{20.0 * kDegree, 1.0};
    const CloudRegistration found = registerClouds(from_left.cloud(), from_left.visibility(), from_right.cloud(),
                                                   from_right.visibility(), motion(10.0 * kDegree, 0.1), options);
    return test::angleOf(found.T_target_source.linear()) / kDegree;
  };
  EXPECT_LT(degreesOff(true), 0.1);
  EXPECT_GT(degreesOff(false), 0.2);
}

TEST(RegisterClouds, RefusesPointsWithoutExtentAndBadOptions) {
  const Points points = blockOnBox(1);
  const auto start = Eigen::Isometry3d::Identity();
  EXPECT_THROW(registerClouds(Points::Zero(3, 50), std::nullopt, points, std::nullopt, start), std::invalid_argument);
  EXPECT_THROW(registerClouds(points, std::nullopt, points.leftCols(1), std::nullopt, start), std::invalid_argument);
  CloudRegistrationOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(registerClouds(points, std::nullopt, points, std::nullopt, start, options), std::invalid_argument);
}

}  // namespace
