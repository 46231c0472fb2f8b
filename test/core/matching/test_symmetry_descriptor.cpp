#include "core/matching/symmetry_descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/base/constants.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {

TEST(SymmetryDescriptors, PeakAtThePlanesOfABox) {
  const Points points = test::box({1.0, 0.7, 0.4}, 4000, test::Sampling::Random, 1).cloud();
  const SymmetryDescriptors descriptors = symmetryDescriptors(points, Eigen::Isometry3d::Identity());
  ASSERT_EQ(descriptors.prst.size(), static_cast<std::size_t>(kPRSTSize));
  ASSERT_EQ(descriptors.prsd.size(), static_cast<std::size_t>(kPRSDSize));
  ASSERT_EQ(descriptors.gedt.size(), static_cast<std::size_t>(kGEDTSize));
  const auto greatest = [](const std::vector<float>& values) {
    const auto at = std::max_element(values.begin(), values.end());
    return std::make_pair(at - values.begin(), *at);
  };
  // The planes of a box pass through its center: the bins of r on either side of 0.
  const auto [bin, value] = greatest(descriptors.prst);
  EXPECT_GT(value, 0.9f);
  EXPECT_TRUE(bin % kDescriptorBins == 15 || bin % kDescriptorBins == 16);
  EXPECT_GT(greatest(descriptors.prsd).second, 0.9f);
  // Where a surface is, f is 1; it holds the box and is 0 far away from it.
  EXPECT_GT(greatest(descriptors.gedt).second, 0.9f);
  EXPECT_EQ(*std::min_element(descriptors.prst.begin(), descriptors.prst.end()) >= 0.0f, true);
}

TEST(SymmetryDescriptors, DoNotDependOnUnitsOrThreads) {
  const Points points = test::box({1.0, 0.7, 0.4}, 2000, test::Sampling::Random, 1).cloud();
  DescriptorOptions options;
  options.num_threads = 1;
  const SymmetryDescriptors one = symmetryDescriptors(points, Eigen::Isometry3d::Identity(), options);
  options.num_threads = 3;
  // A power of two changes no mantissa.
  const SymmetryDescriptors many = symmetryDescriptors(1024.0f * points, Eigen::Isometry3d::Identity(), options);
  EXPECT_EQ(one.prst, many.prst);
  EXPECT_EQ(one.prsd, many.prsd);
  EXPECT_EQ(one.gedt, many.gedt);
}

TEST(SymmetryDescriptors, RefuseWhatCannotBeDescribed) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  EXPECT_THROW(symmetryDescriptors(Points(3, 0), identity), std::invalid_argument);
  EXPECT_THROW(symmetryDescriptors(Points::Zero(3, 10), identity), std::invalid_argument);
  Points broken = Points::Random(3, 10);
  broken(1, 2) = std::nanf("");
  EXPECT_THROW(symmetryDescriptors(broken, identity), std::invalid_argument);
  DescriptorOptions options;
  options.num_samples = 0;
  EXPECT_THROW(symmetryDescriptors(Points::Random(3, 10), identity, options), std::invalid_argument);
}

TEST(PlaneDescriptorDistance, WeighsByTheSizeOfTheBins) {
  std::vector<float> a(kPRSTSize, 1.0f), b(kPRSTSize, 0.0f);
  double expected = 0.0;
  for (int t = 0; t < kDescriptorBins; ++t) expected += 1024.0 * std::sin((t + 0.5) * 0.5 * kPi / kDescriptorBins);
  EXPECT_NEAR(planeDescriptorDistance(a.data(), b.data(), kPRSTSize), std::sqrt(expected), 1e-2);
  EXPECT_NEAR(planeDescriptorDistance(a.data(), b.data(), kPRSDSize), std::sqrt(expected / 32.0), 1e-3);
  EXPECT_THROW(planeDescriptorDistance(a.data(), b.data(), 33), std::invalid_argument);
  EXPECT_NEAR(sqDistance(a.data(), b.data(), 1001), 1001.0, 1e-3);
}

}  // namespace pcl_symmetry
