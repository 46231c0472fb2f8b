/// Models as a database stores them, and the scans that are brought to them.
#include "recognition/packed_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

#include "core/base/constants.h"
#include "core/matching/shape_signature.h"
#include "pcl/kinds.h"
#include "recognition/posed_scan.h"

namespace pcl_symmetry {
namespace {

TEST(PackedModel, PartsComeBackAsTheyWere) {
  const test::Cloud cloud = test::rodOnBox({1.0, 0.8, 0.1}, 0.6, test::elsewhere(), 1);
  EXPECT_EQ(detail::unpackedCloud(detail::packedCloud(cloud)).getMatrixXfMap(3, 4, 0), cloud.getMatrixXfMap(3, 4, 0));
  const auto views = viewsAround(cloud.getMatrixXfMap(3, 4, 0), 40);
  const auto read = detail::unpackedViews(detail::packedViews(views));
  ASSERT_EQ(read.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(read[i].values, views[i].values);
    EXPECT_FLOAT_EQ(static_cast<float>(read[i].radius), static_cast<float>(views[i].radius));
    EXPECT_TRUE(read[i].T_view_input.isApprox(views[i].T_view_input, 1e-6));
  }
  const std::vector<SurfacePoints> surfaces = evenSurfacePoints(cloud.getMatrixXfMap(3, 4, 0), {20, 200}, 1);
  const std::vector<SurfacePoints> read_surfaces = detail::unpackedSurfaces(detail::packedSurfaces(surfaces));
  ASSERT_EQ(read_surfaces.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(read_surfaces[k].points, surfaces[k].points);
    EXPECT_EQ(read_surfaces[k].normals, surfaces[k].normals);
  }
}

TEST(PackedModel, OtherBytesAreRefused) {
  const std::string packed = detail::packedCloud(test::ball());
  EXPECT_EQ(detail::unpackedCloud(detail::packedCloud({})).size(), 0u);
  const std::string no_numbers = detail::packedMatrices({Eigen::MatrixXf::Constant(3, 2, std::nanf(""))});
  // (2^32 - 2) x (2^32 - 1) values, whose bytes are more than 2^64: a few bytes cannot ask for gigabytes.
  const std::string endless = "\xfe" + std::string(7, '\xff');
  for (const std::string& bytes :
       {std::string("x"), packed.substr(0, packed.size() / 2), std::string(100, '\xff'), no_numbers, endless}) {
    EXPECT_THROW(detail::unpackedCloud(bytes), std::invalid_argument);
    EXPECT_THROW(detail::unpackedSignatures(bytes), std::invalid_argument);
    EXPECT_THROW(detail::unpackedViews(bytes), std::invalid_argument);
    EXPECT_THROW(detail::unpackedSurfaces(bytes), std::invalid_argument);
  }
  EXPECT_THROW(detail::unpackedCloud(""), std::invalid_argument);
}

/// The side of a cylinder, and at one side of it a box as a handle, which a sixth of the points show.
Points mug() {
  constexpr int kNumPoints = 6000;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Points points(3, kNumPoints);
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = kPi * uniform(random);
    points.col(i) << static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), uniform(random);
    if (i % 6 == 0)
      points.col(i) << 1.3f + 0.3f * uniform(random), uniform(random) < 0 ? -0.1f : 0.1f, 0.6f * points(2, i);
  }
  return points;
}

double angleOf(const detail::PosedModel& posed) {
  return Eigen::AngleAxisd(posed.model.T_model_scan.linear()).angle();
}

/// From a pose with the handle elsewhere no step leads to the true one, as the cylinder fits in both.
TEST(PosedScan, TriesRotationsAboutTheAxesOfAModel) {
  const Points points = mug();
  for (const double degrees : {50.0, 120.0, 180.0}) {
    const detail::PosedScan scan(points, std::nullopt, 0);
    const detail::PosedModel found = scan.fitModel(
        "mug", points, {Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitZ()))});
    EXPECT_GT(angleOf(found), 45.0 * kDegree) << degrees;
    const detail::PosedModel rotated = scan.rotated(found);
    EXPECT_LT(angleOf(rotated), 2.0 * kDegree) << degrees;
    EXPECT_GT(rotated.model.score.support, 0.95) << degrees;
  }
}

/// A unit sphere seen from z = -5, of which a plate hides the half x < 0.
TEST(ModelEvidence, WhatHidesAModelDoesNotSpeakAgainstIt) {
  constexpr int kNumPoints = 12'000;
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(-1.2f, 1.2f);
  Points sphere(3, kNumPoints), seen(3, 0), all(3, 0);
  const auto append = [](Points& points, const Eigen::Vector3f& point) {
    points.conservativeResize(3, points.cols() + 1);
    points.rightCols<1>() = point;
  };
  for (int i = 0; i < kNumPoints; ++i) {
    sphere.col(i) = Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized();
    if (sphere(0, i) > 0.0f && sphere(2, i) < -0.2f) append(seen, sphere.col(i));
    append(all, {0.5f * uniform(random) - 0.6f, uniform(random), -1.5f});
  }
  for (Eigen::Index i = 0; i < seen.cols(); ++i) append(all, seen.col(i));
  const PosedSurface scan(seen, Visibility::fromPoints(all, {0.0, 0.0, -5.0}), 1, 1), model(sphere, std::nullopt, 1, 1);
  const ModelEvidence right = detail::modelEvidence(scan, model, Eigen::Isometry3d::Identity());
  EXPECT_GT(right.on_model, 0.98);
  EXPECT_NEAR(right.shown, 0.5, 0.1);
  const Eigen::Isometry3d before(Eigen::Translation3d(0.0, 0.0, 0.05)), behind(Eigen::Translation3d(0.0, 0.0, -0.3));
  EXPECT_LT(detail::modelEvidence(scan, model, before).on_model, 0.5);
  EXPECT_LT(detail::modelEvidence(scan, model, behind).shown, 0.2);
  EXPECT_LT(detail::posedInPicture(scan, model, before).translation().norm(), 0.01);
}

}  // namespace
}  // namespace pcl_symmetry
