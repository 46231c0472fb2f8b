
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/matching/view_code.h"

namespace pcl_symmetry {

namespace {

/// Points spread over an ellipsoid with a lump on it.
Points lumpyEllipsoid(const Eigen::Vector3d& half, std::uint64_t seed) {
  Points points(3, 1500);
  RandomStream random(seed);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d x = Eigen::Vector3d::NullaryExpr([&] { return 2.0 * random.uniform() - 1.0; }).normalized();
    x = x.cwiseProduct(half);
    if (i % 6 == 0) x = Eigen::Vector3d(half.x(), 0.3 * half.y(), 0.0) + 0.25 * x;
    points.col(i) = x.cast<float>();
  }
  return points;
}

std::vector<std::vector<View>> viewsOfShapes(int count) {
  std::vector<std::vector<View>> shapes;
  RandomStream random(4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d half(1.0, 0.2 + 0.8 * random.uniform(), 0.2 + 0.8 * random.uniform());
    shapes.push_back(viewsAround(lumpyEllipsoid(half, 10 + static_cast<std::uint64_t>(i)), 12, 1));
  }
  return shapes;
}

std::vector<View> joined(const std::vector<std::vector<View>>& shapes) {
  std::vector<View> views;
  for (const auto& shape : shapes) views.insert(views.end(), shape.begin(), shape.end());
  return views;
}

}  // namespace

TEST(ViewCode, RotationsOfThePictureDoNotChangeIt) {
  const Points points = lumpyEllipsoid({1.0, 0.6, 0.3}, 1);
  const Eigen::Vector3d forward = Eigen::Vector3d(0.3, -1.0, 0.5).normalized();
  const View view = viewOf(points, forward);
  const Eigen::VectorXf own = magnitudesOf(view.values);
  ASSERT_EQ(own.size(), kViewMagnitudes);
  EXPECT_NEAR(own.norm(), 1.0, 1e-5);
  const ViewCoder coder = ViewCoder::fit(viewsAround(points, 40, 1));
  for (const double angle : {0.4, 1.7, -2.6}) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, forward).toRotationMatrix();
    const View rotated = viewOf(rotation.cast<float>() * points, forward);
    EXPECT_GT((rotated.values - view.values).norm(), 0.3) << angle;
    EXPECT_LT((magnitudesOf(rotated.values) - own).norm(), 0.15) << angle;  // the cells of the picture
    const ViewCode a = coder.codeOf(view), b = coder.codeOf(rotated);
    for (std::size_t k = 0; k < kViewCodeSize; ++k) EXPECT_NEAR(a.values[k], b.values[k], 0.15f / kViewCodeStep);
  }
  // Magnitudes are no farther from each other than what they are the magnitudes of.
  const View other = viewOf(points, {1.0, 0.0, 0.2});
  EXPECT_LE((magnitudesOf(other.values) - own).norm(), (other.values - view.values).norm() + 1e-6f);
}

TEST(ViewCode, CoderComesBackFromItsNumbers) {
  const std::vector<View> views = joined(viewsOfShapes(4));
  const ViewCoder coder = ViewCoder::fit(views), again = ViewCoder::fromValues(coder.toValues());
  EXPECT_EQ(coder.codesOf(views), again.codesOf(views));
  EXPECT_EQ(coder.codesOf(views).size(), (kViewCodeSize + 2) * views.size());
  EXPECT_THROW(ViewCoder::fromValues(Eigen::MatrixXf::Zero(3, 3)), std::invalid_argument);
  EXPECT_THROW(ViewCoder::fit({}), std::invalid_argument);
  View huge = views[0];
  huge.radius = 1e30;
  EXPECT_EQ(coder.codeOf(huge).size, 32767) << "it ends at the greatest size";
}

TEST(ViewCodeIndex, FindsWhatAComparisonOfAllCodesFinds) {
  const auto shapes = viewsOfShapes(60);
  const ViewCoder coder = ViewCoder::fit(joined(shapes));
  ViewCodeIndex index;
  for (const auto& views : shapes) index.add(coder.codesOf(views));
  index.add("");  // a shape without views is never found
  EXPECT_EQ(index.numShapes(), 61u);
  EXPECT_EQ(index.numViews(), 720u);
  const double weight = 0.25;
  const ViewCode scan = coder.codeOf(shapes[17][5]);
  std::vector<std::pair<double, int>> distances;
  for (int i = 0; i < 60; ++i) {
    double least = 1e9;
    for (const View& view : shapes[static_cast<std::size_t>(i)]) {
      const ViewCode code = coder.codeOf(view);
      double sum = 0.0;
      for (std::size_t k = 0; k < kViewCodeSize; ++k) sum += std::pow(code.values[k] - scan.values[k], 2.0);
      least = std::min(least, static_cast<double>(kViewCodeStep) * std::sqrt(sum) +
                                  weight * static_cast<double>(kViewSizeStep) * std::abs(code.size - scan.size));
    }
    distances.emplace_back(least, i);
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_EQ(distances[0].second, 17);
  std::vector<int> expected;
  for (std::size_t i = 0; i < 10; ++i) expected.push_back(distances[i].second);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(index.nearest(scan, weight, 10, 1), expected);
  EXPECT_EQ(index.nearest(scan, weight, 10, 3), expected);
  EXPECT_EQ(index.nearest(scan, weight, 100, 1).size(), 60u);
  EXPECT_TRUE(index.nearest(scan, weight, 0, 1).empty());
  EXPECT_THROW(index.nearest(scan, weight, -1, 1), std::invalid_argument);
  EXPECT_THROW(index.add("12345"), std::invalid_argument);
}

}  // namespace pcl_symmetry
