/// Models as a database stores them, and the scans that are brought to them.
#include "recognition/packed_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
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
  RandomStream random(1);
  Points points(3, 6000);
  for (int i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d u = test::randomPoint(random);
    const Eigen::Vector3d wall(std::cos(kPi * u.x()), std::sin(kPi * u.x()), u.z());
    const Eigen::Vector3d handle(1.3 + 0.3 * u.x(), u.y() < 0.0 ? -0.1 : 0.1, 0.6 * u.z());
    points.col(i) = (i % 6 == 0 ? handle : wall).cast<float>();
  }
  return points;
}

double angleOf(const detail::PosedModel& posed) {
  return test::angleOf(posed.model.T_model_scan.linear());
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
  const Points sphere = test::sphere(12'000, 1).cloud();
  const Points seen = test::pointsWhere(sphere, [](const Eigen::Vector3f& x) { return x.x() > 0.0f && x.z() < -0.2f; });
  const Points plate = (Eigen::Vector3f(0.6f, 1.2f, 0.0f).asDiagonal() * Points::Random(3, 12'000)).colwise() +
                       Eigen::Vector3f(-0.6f, 0.0f, -1.5f);
  const PosedSurface scan(seen, Visibility::fromPoints(test::joined(plate, seen), {0.0, 0.0, -5.0}), 1, 1),
      model(sphere, std::nullopt, 1, 1);
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
