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
#include "shapes/complaint.h"

namespace pcl_symmetry {
namespace {

TEST(PackedModel, ViewsKeepWhatTheyTellApart) {
  const test::Cloud cloud = test::rodOnBox({1.0, 0.8, 0.1}, 0.6, test::elsewhere(), 1);
  const auto views = viewsAround(cloud.getMatrixXfMap(3, 4, 0), 40);
  const std::string bytes = detail::packedViews(views);
  EXPECT_LT(bytes.size(), 40u * 170u);
  const auto read = detail::unpackedViews(bytes);
  ASSERT_EQ(read.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_LT((read[i].values - views[i].values).norm(), 0.07f);  // 272 values, each wrong by at most 1/192
    EXPECT_FLOAT_EQ(static_cast<float>(read[i].radius), static_cast<float>(views[i].radius));
    const Eigen::Isometry3d error = read[i].T_view_input * views[i].T_view_input.inverse();
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 2e-4);
  }
}

TEST(PackedModel, SurfacesKeepTheirOrder) {
  const test::Cloud cloud = test::rodOnBox({1.0, 0.8, 0.1}, 0.6, test::elsewhere(), 1);
  const std::vector<SurfacePoints> surfaces = evenSurfacePoints(cloud.getMatrixXfMap(3, 4, 0), {20, 200}, 1);
  const std::vector<SurfacePoints> read = detail::unpackedSurfaces(detail::packedSurfaces(surfaces));
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_EQ(read[k].points.cols(), surfaces[k].points.cols());
    // Half a step of coordinates of at most 2, and of the floats about them.
    EXPECT_LT((read[k].points - surfaces[k].points).cwiseAbs().maxCoeff(), 1.0f / 32767 + 1e-5f);
    EXPECT_LT((read[k].normals - surfaces[k].normals).cwiseAbs().maxCoeff(), 1.0f / 32767);
  }
}

TEST(PackedModel, MatricesKeepHalfAStep) {
  RandomStream random(1);
  const Eigen::MatrixXf matrix =
      Eigen::MatrixXf::NullaryExpr(50, 7, [&] { return static_cast<float>(random.uniform() - 0.5); });
  for (const auto& [bits, steps] :
       {std::pair(detail::MatrixBits::Eight, 127.0f), std::pair(detail::MatrixBits::Sixteen, 32767.0f)}) {
    const Eigen::MatrixXf read = detail::unpackedMatrix(detail::packedMatrix(matrix, bits));
    ASSERT_EQ(read.cols(), 7);
    for (Eigen::Index i = 0; i < 7; ++i)
      EXPECT_LE((read - matrix).col(i).cwiseAbs().maxCoeff(), 0.501f * matrix.col(i).cwiseAbs().maxCoeff() / steps);
  }
  EXPECT_TRUE(
      detail::unpackedMatrix(detail::packedMatrix(Eigen::MatrixXf::Zero(3, 2), detail::MatrixBits::Eight)).isZero());
}

TEST(PackedModel, OtherBytesAreRefused) {
  const test::Cloud cloud = test::ball();
  const std::string packed = detail::packedCloud(cloud);
  EXPECT_EQ(detail::unpackedCloud(packed).size(), cloud.size());
  EXPECT_EQ(detail::unpackedCloud(detail::packedCloud({})).size(), 0u);
  const std::string other[] = {"", "x", packed.substr(0, packed.size() / 2), std::string(100, '\xff'),
                               detail::compressed(std::string(60, '\x7f'), detail::Effort::Low)};
  for (const std::string& bytes : other) {
    EXPECT_THROW(detail::unpackedCloud(bytes), std::invalid_argument);
    EXPECT_THROW(detail::unpackedSignatures(bytes), std::invalid_argument);
    EXPECT_THROW(detail::unpackedViews(bytes), std::invalid_argument);
    if (bytes.empty()) continue;
    EXPECT_THROW(detail::unpackedSurfaces(bytes), std::invalid_argument);
  }
}

/// A few bytes cannot ask for gigabytes.
TEST(PackedModel, SizesThatTheBytesCannotHoldAreRefused) {
  detail::PackedBytes gigabyte;
  gigabyte.put(std::uint32_t{1u << 30});
  gigabyte.append("....");
  const auto messageOf = [](const std::string& bytes, auto unpack) {
    return test::complaintOf<std::invalid_argument>([&] { unpack(bytes); });
  };
  EXPECT_EQ(messageOf(gigabyte.bytes(), detail::decompressed), "has fewer bytes than it says");
  const std::string zeros(1 << 20, '\0');
  EXPECT_EQ(detail::decompressed(detail::compressed(zeros, detail::Effort::High)), zeros) << "nothing shrinks more";
  // (2^32 - 2) rows of two bytes and four more, times 2^31 columns, are 2^64 bytes.
  detail::PackedBytes matrix;
  matrix.put(std::uint8_t{2});
  matrix.put(std::uint32_t{0xfffffffe});
  matrix.put(std::uint32_t{1u << 31});
  EXPECT_EQ(messageOf(matrix.bytes(), detail::unpackedMatrix), "has another size than it says");
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
    const detail::PosedModel found =
        scan.fitted("mug", points, {Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitZ()))});
    EXPECT_GT(angleOf(found), 45.0 * kDegree) << degrees;
    const detail::PosedModel rotated = scan.rotated(found);
    EXPECT_LT(angleOf(rotated), 2.0 * kDegree) << degrees;
    EXPECT_GT(rotated.model.score.support, 0.95) << degrees;
  }
}

}  // namespace
}  // namespace pcl_symmetry
