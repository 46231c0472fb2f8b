#include "recognition/packed_model.h"

#include <gtest/gtest.h>

#include <string>

#include "core/matching/shape_signature.h"
#include "pcl/kinds.h"
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
  // derived: (2^32 - 2) rows of two bytes and four more, times 2^31 columns, are 2^64 bytes.
  detail::PackedBytes matrix;
  matrix.put(std::uint8_t{2});
  matrix.put(std::uint32_t{0xfffffffe});
  matrix.put(std::uint32_t{1u << 31});
  EXPECT_EQ(messageOf(matrix.bytes(), detail::unpackedMatrix), "has another size than it says");
}

}  // namespace

}  // namespace pcl_symmetry
