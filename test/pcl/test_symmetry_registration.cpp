#include "pcl_symmetry/symmetry_registration.h"

#include <gtest/gtest.h>
#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/registration/icp.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <set>

#include "pcl/clouds.h"
#include "pcl/error_message.h"
#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

template <typename PointT = pcl::PointXYZ>
using CloudPtr = typename pcl::PointCloud<PointT>::Ptr;

template <typename PointT = pcl::PointXYZ>
CloudPtr<PointT> toCloud(const Points& points) {
  return test::toCloud<PointT>(Shape{points.cast<double>(), {}});
}

/// A scan of the chair, which has no rotation of its own, moved by \p pose; it says where the scanner stood.
template <typename PointT = pcl::PointXYZ>
CloudPtr<PointT> chairScan(const Eigen::Isometry3d& pose) {
  const Scan scan = test::scan(blockChair(), {3.0, -6.0, 4.0});
  const auto cloud = toCloud<PointT>((pose.cast<float>() * scan.cloud()).eval());
  cloud->sensor_origin_.template head<3>() = (pose * scan.viewpoint).cast<float>();
  return cloud;
}

CloudPtr<> chairModel() {
  return toCloud(surfaceOf(blockChair(), 6000));
}

double angleOf(const Eigen::Matrix4f& transform) {
  return Eigen::AngleAxisd(transform.topLeftCorner<3, 3>().cast<double>()).angle();
}

class SymmetryRegistrationTest : public testing::Test {
protected:
  void SetUp() override {
    level_ = pcl::console::getVerbosityLevel();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  void TearDown() override { pcl::console::setVerbosityLevel(level_); }

private:
  pcl::console::VERBOSITY_LEVEL level_;
};

/// What a user has who knows nothing of us.
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
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  const auto scan = chairScan(randomPose(3)), with_gaps = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*scan);
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 100; ++i) with_gaps->push_back(pcl::PointXYZ(none, none, none));
  with_gaps->is_dense = false;
  registration.setInputTarget(chairModel());
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration.setInputSource(scan);
  registration.align(aligned);
  const double expected = registration.getFitnessScore();
  EXPECT_LT(expected, 0.03 * 0.03);
  EXPECT_LT(registration.getFitnessScore(0.5 * expected), 0.5 * expected);
  registration.setInputSource(with_gaps);
  registration.align(aligned);
  ASSERT_TRUE(registration.hasConverged());
  pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>& as_any = registration;
  EXPECT_NEAR(as_any.getFitnessScore(), expected, 0.05 * expected);
}

TEST_F(SymmetryRegistrationTest, BringsWholesTogetherInDoublesAndTurnsNormals) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d pose = randomPose(2);
  const auto source = test::toCloud<pcl::PointNormal>(moved(shape, pose));
  for (pcl::PointNormal& point : *source) point.getNormalVector3fMap() = Eigen::Vector3f::UnitX();
  SymmetryRegistration<pcl::PointNormal, pcl::PointNormal, double> registration;
  registration.setInputSource(source);
  registration.setInputTarget(test::toCloud<pcl::PointNormal>(asymmetricBlob(4000, 2)));
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
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  PoseSearchOptions options;
  options.num_rotations = 0;
  registration.setSearchOptions(options);
  registration.setUseFrames(false);
  registration.setInputSource(scan);
  registration.setIndices(indices);
  registration.setInputTarget(chairModel());
  pcl::PointCloud<pcl::PointXYZ> aligned;
  Eigen::Isometry3d guess(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  registration.align(aligned, (guess * pose.inverse()).matrix().cast<float>());
  ASSERT_TRUE(registration.hasConverged()) << "the guess alone leads there";
  EXPECT_LT(angleOf(registration.getFinalTransformation() * pose.matrix().cast<float>()), 2.0 * kDegree);
  EXPECT_EQ(aligned.size(), size);
}

/// The motion from one frame of a track to the next, about the middle of the chair.
Eigen::Isometry3d motion(double angle, double distance) {
  const Eigen::Vector3d along = Eigen::Vector3d(2.0, -1.0, 0.5).normalized();
  return Eigen::Translation3d(distance * along) * Eigen::AngleAxisd(angle, along.unitOrthogonal());
}

TEST_F(SymmetryRegistrationTest, TracksAroundTheGuess) {
  const Eigen::Isometry3d pose = randomPose(7);
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(chairScan(pose));
  const auto model = chairModel();
  registration.setInputTarget(model);
  const double diagonal =
      (model->getMatrixXfMap(3, 4, 0).rowwise().maxCoeff() - model->getMatrixXfMap(3, 4, 0).rowwise().minCoeff())
          .norm();
  const auto align = [&](const Eigen::Isometry3d& off) {
    pcl::PointCloud<pcl::PointXYZ> aligned;
    registration.align(aligned, (off * pose.inverse()).matrix().cast<float>());
  };
  registration.setSearchAround(25.0 * kDegree, 0.4 * diagonal);
  align(motion(15.0 * kDegree, 0.1 * diagonal));
  ASSERT_TRUE(registration.hasConverged()) << registration.getReason();
  EXPECT_LT(angleOf(registration.getFinalTransformation() * pose.matrix().cast<float>()), 2.0 * kDegree);
  for (const auto& [stage, time] : registration.getTiming()) EXPECT_NE(stage, "frames");

  registration.setSearchAround(5.0 * kDegree, 0.4 * diagonal);
  align(motion(60.0 * kDegree, 0.0));
  EXPECT_FALSE(registration.hasConverged()) << "the true pose is farther away";
  EXPECT_EQ(registration.getReason().rfind("nothing fits around the guess", 0), 0u) << registration.getReason();
  registration.setSearchEverywhere();
  align(motion(60.0 * kDegree, 0.0));
  EXPECT_TRUE(registration.hasConverged());
}

/// Of a box with three half turns only the pose next to the last frame is right for a track.
TEST_F(SymmetryRegistrationTest, TracksDoNotFlip) {
  const auto box = test::toCloud(test::box(4000, Sampling::Random, 1));
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(box);
  registration.setInputTarget(box);
  registration.setSearchAround(40.0 * kDegree, 10.0);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Isometry3d half_turn(Eigen::AngleAxisd(kPi, Eigen::Vector3d::Unit(k)));
    const Eigen::Isometry3d guess = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()) * half_turn;
    pcl::PointCloud<pcl::PointXYZ> aligned;
    registration.align(aligned, guess.matrix().cast<float>());
    ASSERT_TRUE(registration.hasConverged()) << registration.getReason();
    EXPECT_LT(angleOf(registration.getFinalTransformation() * half_turn.matrix().cast<float>()), 3.0 * kDegree);
  }
}

TEST_F(SymmetryRegistrationTest, ListsThePosesThatSymmetryMakesEqual) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(test::toCloud(test::box(4000, Sampling::Random, 1)));
  registration.setInputTarget(test::toCloud(test::box(4000, Sampling::Random, 2)));
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration.align(aligned);
  ASSERT_TRUE(registration.hasConverged());
  const std::vector<RegisteredPose>& poses = registration.getPoses();
  ASSERT_EQ(poses.size(), 4u) << "the identity and three half turns";
  EXPECT_TRUE(poses[0].T_target_source.matrix().cast<float>().isApprox(registration.getFinalTransformation()));
  EXPECT_EQ(poses[0].score.merit(), registration.getScore().merit());
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
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  pcl::PointCloud<pcl::PointXYZ> aligned;
  const auto fails = [&](const CloudPtr<>& source, const CloudPtr<>& target) {
    registration.setInputSource(source);
    registration.setInputTarget(target);
    registration.align(aligned);
    EXPECT_FALSE(registration.hasConverged());
    EXPECT_EQ(registration.getFinalTransformation(), Eigen::Matrix4f::Identity());
    ASSERT_EQ(aligned.size(), source->size());
    EXPECT_EQ(aligned[0].x, (*source)[0].x) << "the source as it was";
    EXPECT_NE(registration.getReason(), "");
  };
  const auto chair = chairScan(randomPose(1)), model = chairModel();
  fails(chair, test::toCloud(sphere(4000, 1)));
  EXPECT_LT(registration.getScore().merit(), 0.4);
  EXPECT_EQ(registration.getReason().rfind("nothing fits", 0), 0u);
  fails(toCloud(Points::Ones(3, 5)), model);
  fails(chair, toCloud(Points::Ones(3, 1)));
  EXPECT_EQ(registration.getReason().rfind("target: ", 0), 0u);
  fails(toCloud(Points::Random(3, 19)), model);
  EXPECT_EQ(registration.getReason().rfind("source: ", 0), 0u);
  EXPECT_EQ(registration.getScore().support, 0.0) << "that of the last pair is gone";
}

/// So few points fit any object at the distance that they are apart.
TEST_F(SymmetryRegistrationTest, TooFewPointsDoNotConvergeOnAnotherObject) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  pcl::PointCloud<pcl::PointXYZ> aligned;
  testing::internal::CaptureStderr();
  const auto converges = [&](const Shape& source, const Shape& target) {
    registration.setInputSource(test::toCloud(moved(source, randomPose(4))));
    registration.setInputTarget(test::toCloud(target));
    registration.align(aligned);
    return registration.hasConverged();
  };
  const auto chair = [](int size) { return Shape{surfaceOf(blockChair(), size).cast<double>(), {}}; };
  for (const int size : {20, 100, 200, 400}) {
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
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setSearchAround(25.0 * kDegree, 0.5);
  registration.setInputTarget(model);
  registration.setInputSource(scan);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  const auto align = [&] {
    registration.align(aligned, (motion(0.1, 0.05) * pose.inverse()).matrix().cast<float>());
    return Eigen::Matrix4f(registration.getFinalTransformation());
  };
  const Eigen::Matrix4f first = align();
  ASSERT_TRUE(registration.hasConverged());
  // What becomes of the points after the first align() does not count until the target is set again.
  const pcl::PointCloud<pcl::PointXYZ> before = *model;
  for (pcl::PointXYZ& point : *model) point.getVector3fMap().setConstant(1.0f);
  EXPECT_EQ(align(), first);
  EXPECT_TRUE(registration.hasConverged());
  registration.setInputTarget(model);
  align();
  EXPECT_FALSE(registration.hasConverged());
  EXPECT_EQ(registration.getReason().rfind("target: ", 0), 0u) << registration.getReason();
  *model = before;
  registration.setInputTarget(model);
  EXPECT_EQ(align(), first);
  // What the target is prepared with counts at once.
  for (pcl::PointXYZ& point : *model) point.getVector3fMap().setConstant(1.0f);
  registration.setRandomSeed(2);
  align();
  EXPECT_FALSE(registration.hasConverged());
}

TEST_F(SymmetryRegistrationTest, GivesACovarianceWhereItConverges) {
  const Eigen::Isometry3d pose = randomPose(7);
  const auto scan = chairScan(pose), model = chairModel();
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  pcl::PointCloud<pcl::PointXYZ> aligned;
  const auto deviations = [&](const CloudPtr<>& source, const CloudPtr<>& target) {
    registration.setInputSource(source);
    registration.setInputTarget(target);
    registration.align(aligned);
    EXPECT_TRUE(registration.hasConverged());
    const Eigen::Matrix<double, 6, 6> covariance = registration.getCovariance().value();
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(covariance).info(), Eigen::Success) << "positive definite";
    return covariance.diagonal().cwiseSqrt().eval();
  };
  // The residuals of an exact scan are those of tangent planes between points: less than a spacing of 0.03.
  for (const bool swapped : {false, true}) {
    const auto found = swapped ? deviations(model, scan) : deviations(scan, model);
    EXPECT_LT(found.maxCoeff(), 0.03) << swapped;
    EXPECT_GT(found.minCoeff(), 1e-6) << swapped;
  }
  registration.setInputTarget(test::toCloud(sphere(4000, 1)));
  registration.align(aligned);
  EXPECT_FALSE(registration.hasConverged());
  EXPECT_FALSE(registration.getCovariance());
  EXPECT_FALSE(registration.getPoses().empty());
  // Nothing fixes how a sphere is turned.
  const auto open = deviations(test::toCloud(sphere(4000, 1)), test::toCloud(sphere(4000, 2)));
  EXPECT_GT(open.head<3>().minCoeff(), 0.5);
  EXPECT_LT(open.tail<3>().maxCoeff(), 0.03);
}

TEST_F(SymmetryRegistrationTest, DoesNotDependOnThreadsAndUnits) {
  const Eigen::Isometry3d pose = randomPose(7);
  const auto scan = chairScan(pose), model = chairModel();
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  const auto transform = [&] {
    registration.setInputSource(scan);
    registration.setInputTarget(model);
    pcl::PointCloud<pcl::PointXYZ> aligned;
    registration.align(aligned);
    EXPECT_TRUE(registration.hasConverged());
    return Eigen::Matrix4f(registration.getFinalTransformation());
  };
  registration.setNumberOfThreads(1);
  const Eigen::Matrix4f expected = transform();
  registration.setNumberOfThreads(4);
  EXPECT_EQ(transform(), expected);
  constexpr float kMillimetres = 1000.0f;
  for (const auto& cloud : {scan, model}) {
    for (pcl::PointXYZ& point : *cloud) point.getVector3fMap() *= kMillimetres;
    cloud->sensor_origin_.head<3>() *= kMillimetres;
  }
  const Eigen::Matrix4f scaled = transform();
  EXPECT_LT(angleOf(scaled * expected.inverse()), 1.0 * kDegree);
  EXPECT_LT((scaled.topRightCorner<3, 1>() / kMillimetres - expected.topRightCorner<3, 1>()).norm(), 0.02);
}

TEST_F(SymmetryRegistrationTest, RefusesWrongParameters) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  EXPECT_EQ(messageOf([&] { registration.setMinMerit(1.5); }), "min_merit = 1.5, must be in [-1, 1]");
  EXPECT_EQ(messageOf([&] { registration.setMaxPoints(2); }), "max_points = 2, must be >= 3");
  EXPECT_EQ(messageOf([&] { registration.setNumberOfThreads(-1); }), "num_threads = -1, must be >= 0");
  EXPECT_EQ(messageOf([&] { registration.setSearchAround(0.0, 1.0); }), "around.angle = 0, must be in (0, pi]");
  EXPECT_EQ(messageOf([&] { registration.setSearchAround(0.1, -1.0); }), "around.distance = -1, must be >= 0");
  PoseSearchOptions options;
  options.max_poses = 0;
  EXPECT_THROW(registration.setSearchOptions(options), pcl::BadArgumentException);
  registration.setInputSource(chairModel());
  registration.setInputTarget(chairModel());
  registration.setSourceViewpoint({Viewpoint::Mode::Given, Eigen::Vector3d::Zero()});
  pcl::PointCloud<pcl::PointXYZ> aligned;
  EXPECT_THROW(registration.align(aligned), pcl::BadArgumentException) << "among the points";
}

}  // namespace
