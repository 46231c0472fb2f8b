#include "pcl_symmetry/symmetry_registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/registration/pose_covariance.h"

namespace pcl_symmetry {
namespace {

/// Points on the faces of a box of 4 x 3 x 2, and on a block on its top that leaves it no symmetry.
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

/// Normal noise of deviation 1. derived: twelve uniform numbers have variance 1 in sum.
double normalNoise(RandomStream& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// Errors of poses as small motions (w, t) of the target's frame, and the covariances that were said of them.
struct PoseErrors {
  MotionCovariance scatter = MotionCovariance::Zero(), said = MotionCovariance::Zero();
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
    Points source = blockOnBox(10 + i), target = (T_target_source * blockOnBox(500 + i).cast<double>()).cast<float>();
    for (Points* points : {&source, &target})
      for (Eigen::Index k = 0; k < points->size(); ++k)
        points->data()[k] += static_cast<float>(noise * normalNoise(random));
    const CloudRegistration found =
        registerClouds(source, std::nullopt, target, std::nullopt, T_target_source, options);
    const Eigen::Isometry3d error = T_target_source * found.T_target_source.inverse();
    const Eigen::AngleAxisd turn(error.linear());
    Motion6d motion;
    motion << turn.angle() * turn.axis(), error.translation();
    errors.scatter += motion * motion.transpose() / num_trials;
    errors.said += *found.covariance / num_trials;
    errors.mean_sq_distance += motion.dot(found.covariance->ldlt().solve(motion)) / num_trials;
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
}  // namespace pcl_symmetry
