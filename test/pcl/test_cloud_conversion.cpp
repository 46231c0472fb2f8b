#include "pcl_symmetry/impl/cloud_conversion.hpp"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <limits>

#include "pcl/error_message.h"

namespace pcl_symmetry::detail {
namespace {

using test::messageOf;

TEST(CloudConversion, MessagesHoldTheirTextAlone) {
  EXPECT_EQ(messageOf([] { throwBadArgument("sigma = -1, must be > 0"); }), "sigma = -1, must be > 0");
  EXPECT_EQ(messageOf([] { withBadArguments([] { throw std::invalid_argument("r = 0, must be > 0"); }); }),
            "r = 0, must be > 0");
  EXPECT_EQ(messageOf([] { checkAtLeast("n", 2, 3); }), "n = 2, must be >= 3");
  EXPECT_NO_THROW(checkAtLeast("n", 3, 3));
  EXPECT_EQ(withBadArguments([] { return 7; }), 7);
}

struct Options {
  int size = 1;
  void validate() const {
    if (size < 1) throw std::invalid_argument("size = " + std::to_string(size) + ", must be >= 1");
  }
};

TEST(CloudConversion, OptionsThatAreRefusedStayAsTheyWere) {
  Options options;
  changeOptions(options, [](Options& changed) { changed.size = 5; });
  EXPECT_EQ(options.size, 5);
  EXPECT_EQ(messageOf([&] { changeOptions(options, [](Options& changed) { changed.size = 0; }); }),
            "size = 0, must be >= 1");
  EXPECT_EQ(options.size, 5);
}

TEST(CloudConversion, DrawsTheSameOfTheFinitePointsWhateverElseIsThere) {
  pcl::PointCloud<pcl::PointXYZ> finite, mixed;
  pcl::Indices place_in_mixed;
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 1000; ++i) {
    finite.emplace_back(static_cast<float>(i), 1.0f, 2.0f);
    if (i % 3 == 0) mixed.emplace_back(0.0f, none, 0.0f);
    place_in_mixed.push_back(static_cast<pcl::index_t>(mixed.size()));
    mixed.push_back(finite.back());
  }
  for (const std::size_t max_points : {std::size_t{10}, std::size_t{999}, std::size_t{1000}, std::size_t{2000}}) {
    const SelectedPoints of_finite = selectPoints(finite, nullptr, max_points, 3);
    const SelectedPoints of_mixed = selectPoints(mixed, nullptr, max_points, 3);
    ASSERT_EQ(of_finite.indices.size(), std::min<std::size_t>(max_points, 1000));
    ASSERT_EQ(of_mixed.points, of_finite.points);
    for (std::size_t i = 0; i < of_finite.indices.size(); ++i) {
      EXPECT_EQ(of_finite.points(0, static_cast<Eigen::Index>(i)), static_cast<float>(of_finite.indices[i]));
      EXPECT_EQ(of_mixed.indices[i], place_in_mixed[static_cast<std::size_t>(of_finite.indices[i])]);
    }
    EXPECT_EQ(selectPoints(mixed, &place_in_mixed, max_points, 3).indices, of_mixed.indices);
  }
}

TEST(CloudConversion, ReasonsNameTheInput) {
  EXPECT_EQ(reasonForNoAnswer(Points(3, 0), "source"), "source: no finite point");
  EXPECT_EQ(reasonForNoAnswer(Points::Random(3, 20)), "");
  EXPECT_NE(reasonForNoAnswer(Points::Random(3, 19)).find("input cloud: 19 distinct points"), std::string::npos);
}

}  // namespace
}  // namespace pcl_symmetry::detail
