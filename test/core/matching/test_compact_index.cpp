#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/matching/compact_index.h"

namespace pcl_symmetry {

namespace {

/// Unit vectors whose components fall as those of compact signatures do.
Eigen::MatrixXf syntheticForms(int dimensions, int count, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXf forms = Eigen::MatrixXf::NullaryExpr(dimensions, count, [&] {
    return static_cast<float>(random.uniform() + random.uniform() + random.uniform() - 1.5);
  });
  for (int d = 0; d < dimensions; ++d) forms.row(d) *= static_cast<float>(std::pow(1.0 + d, -0.5));
  forms.colwise().normalize();
  return forms;
}

/// The least distance of two shapes over all of their forms.
float signatureDistance(const Eigen::MatrixXf& rotations, const Eigen::Ref<const Eigen::MatrixXf>& compact) {
  return std::sqrt(std::max(0.0f, 2.0f - 2.0f * (rotations.transpose() * compact).maxCoeff()));
}

}  // namespace

TEST(CompactIndex, FindsWhatAComparisonOfAllFinds) {
  const Eigen::MatrixXf forms = syntheticForms(32, 600, 1), queries = syntheticForms(32, 5, 2);
  CompactIndexOptions options;
  options.num_candidates = 600;
  const CompactIndex index(forms, 2, options);
  EXPECT_EQ(index.numShapes(), 300);
  const auto nearest = index.nearest(queries, 10);
  ASSERT_EQ(nearest.size(), 10u);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const auto own = forms.middleCols(2 * nearest[i].first, 2);
    EXPECT_NEAR(nearest[i].second, signatureDistance(queries, own), 1e-4);
    EXPECT_TRUE(i == 0 || nearest[i].second >= nearest[i - 1].second);
  }
  int nearer = 0;
  for (int shape = 0; shape < 300; ++shape)
    nearer += signatureDistance(queries, forms.middleCols(2 * shape, 2)) < nearest.back().second - 1e-4f ? 1 : 0;
  EXPECT_EQ(nearer, 9);
}

TEST(CompactIndex, ScalesDistancesBeforeItChooses) {
  const Eigen::MatrixXf forms = syntheticForms(64, 6000, 1), queries = syntheticForms(64, 24, 2);
  RandomStream random(4);
  std::vector<float> typical;
  for (int i = 0; i < 3000; ++i) typical.push_back(static_cast<float>(0.5 + random.uniform()));
  const auto scaled = [&](int shape) {
    return signatureDistance(queries, forms.middleCols(2 * shape, 2)) /
           std::sqrt(typical[static_cast<std::size_t>(shape)]);
  };
  CompactIndexOptions options;
  options.num_leading = 64;
  const auto nearest = CompactIndex(forms, 2, options, typical).nearest(queries, 3);
  ASSERT_EQ(nearest.size(), 3u);
  int nearer = 0;
  for (int shape = 0; shape < 3000; ++shape) nearer += scaled(shape) < nearest[2].second - 1e-4f ? 1 : 0;
  EXPECT_EQ(nearer, 2) << "as a comparison of all";
  for (const auto& [shape, distance] : nearest) EXPECT_NEAR(distance, scaled(shape), 1e-4);
  EXPECT_THROW(CompactIndex(forms, 2, options, {1.0f}), std::invalid_argument);
  typical[7] = 0.0f;
  EXPECT_THROW(CompactIndex(forms, 2, options, typical), std::invalid_argument);
}

TEST(CompactIndex, FindsTheNearestOfManyByLeadingComponents) {
  const Eigen::MatrixXf forms = syntheticForms(64, 20'000, 1), noise = syntheticForms(64, 50, 3);
  const CompactIndex index(forms, 2);
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::MatrixXf query = (forms.col(300 * i) + 0.5f * noise.col(i)).normalized();
    const auto nearest = index.nearest(query, 1);
    ASSERT_EQ(nearest.size(), 1u);
    found += nearest[0].first == 150 * i ? 1 : 0;
  }
  EXPECT_GE(found, 48);
}

TEST(CompactIndex, CopesWithLittleAndRefusesNonsense) {
  EXPECT_TRUE(CompactIndex().nearest(Eigen::MatrixXf::Ones(4, 1), 3).empty());
  const CompactIndex one(syntheticForms(4, 1, 1), 1);
  EXPECT_EQ(one.nearest(syntheticForms(4, 1, 1), 5).size(), 1u);
  EXPECT_TRUE(one.nearest(syntheticForms(4, 1, 1), 0).empty());
  EXPECT_THROW(one.nearest(syntheticForms(5, 1, 1), 1), std::invalid_argument);
  EXPECT_THROW(one.nearest(syntheticForms(4, 1, 1), -1), std::invalid_argument);
  EXPECT_THROW(CompactIndex(syntheticForms(4, 3, 1), 2), std::invalid_argument);
}

TEST(TypicalDistance, IsTheMeanOfTheNearest) {
  constexpr float kItself = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, 1.0f, kItself, 2.0f, 9.0f}, 3), (1.0f + 2.0f + 4.0f) / 3.0f);
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, kItself, 1.0f}, 10), 2.5f);
  EXPECT_FLOAT_EQ(typicalDistance({kItself}), 1.0f);
  EXPECT_GT(typicalDistance({0.0f, 0.0f}), 0.0f);
}

}  // namespace pcl_symmetry
