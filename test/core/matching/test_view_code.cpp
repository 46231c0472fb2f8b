#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/matching/view_code.h"
#include "core/matching/view_index.h"

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

/// The surface of a slab with a tower on one end, 8000 points.
Points slabWithTower(double length, double height) {
  Points points(3, 8000);
  RandomStream random(3);
  const auto side = [&] { return 2.0 * random.uniform() - 1.0; };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d x(side(), side(), side());
    x[i % 3] = x[i % 3] < 0.0 ? -1.0 : 1.0;
    const bool tower = i % 4 == 0;
    x = x.cwiseProduct(tower ? Eigen::Vector3d(0.2, 0.15, height) : Eigen::Vector3d(length, 0.5, 0.2));
    if (tower) x += Eigen::Vector3d(0.7 * length, 0.2, height);
    points.col(i) = x.cast<float>();
  }
  return points;
}

Eigen::Isometry3d motion(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  T.translation() = translation;
  return T;
}

Points moved(const Points& points, const Eigen::Isometry3d& T) {
  return (T * points.cast<double>()).cast<float>();
}

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
}

constexpr double kAngleStep = 2.0 * M_PI / 48.0;

TEST(ViewSignature, HasUnitNormAndItsSizeAndPlace) {
  const Points points = slabWithTower(1.0, 0.6);
  const View view = viewOf(points, {0.0, 0.0, -1.0});
  ASSERT_EQ(view.values.size(), kViewSignatureSize);
  EXPECT_NEAR(view.values.norm(), 1.0, 1e-5);
  // From above the outline is the slab of 2 x 1: its root mean square radius is sqrt((2^2 + 1^2) / 12).
  EXPECT_NEAR(view.radius, std::sqrt(5.0 / 12.0), 0.02);
  const Eigen::Vector3d middle = view.T_view_input.inverse() * Eigen::Vector3d::Zero();
  EXPECT_NEAR(middle.x(), 0.0, 2.0 / 48.0);  // a cell of the outline
  EXPECT_NEAR(middle.y(), 0.0, 2.0 / 48.0);
  EXPECT_GT((view.T_view_input * Eigen::Vector3d(0.0, 0.0, -5.0)).z(), 4.0);  // z points away from the viewer
}

TEST(ViewSignature, DoesNotChangeWithSizeAndPlace) {
  const Points points = slabWithTower(1.0, 0.6);
  const View view = viewOf(points, {1.0, 2.0, -1.0});
  for (const float scale : {1e-6f, 1e6f}) {
    Points scaled = scale * points;
    scaled.colwise() += scale * Eigen::Vector3f(3.0f, -2.0f, 5.0f);
    const View other = viewOf(scaled, {1.0, 2.0, -1.0});
    EXPECT_LT((view.values - other.values).norm(), 0.02) << scale;
    EXPECT_NEAR(other.radius / scale, view.radius, 1e-3 * view.radius);
  }
}

TEST(ViewSignature, ARotationOfThePictureIsFound) {
  const Points points = slabWithTower(1.0, 0.6);
  const Eigen::Vector3d forward = Eigen::Vector3d(1.0, 2.0, -3.0).normalized();
  const View view = viewOf(points, forward);
  for (const double angle : {0.0, 0.6, 2.0, -1.1, 3.1}) {
    const Eigen::Isometry3d T = motion(angle, forward, {4.0, 1.0, -2.0});
    const View rotated = viewOf(moved(points, T), forward);
    const ViewAgreement agreement = ViewComparison(rotated).compare(view.values.data(), 2.0f);
    EXPECT_LT(agreement.distance, 0.15f) << angle;
    const Eigen::Isometry3d pose = poseOfView(rotated, view, agreement.angle);
    EXPECT_LT(angleBetween(pose, T.inverse()), 0.5 * kAngleStep + 0.02) << angle;
    EXPECT_LT((pose * (T * Eigen::Vector3d::Zero())).norm(), 0.1) << angle;
  }
}

TEST(ViewSignature, ComparisonStopsWhereNothingNearerCanBe) {
  const View view = viewOf(slabWithTower(1.0, 0.6), {1.0, 2.0, -3.0});
  const View other = viewOf(slabWithTower(3.0, 0.2), {0.0, 1.0, 0.0});
  const ViewAgreement agreement = ViewComparison(view).compare(other.values.data(), 2.0f);
  ASSERT_GT(agreement.distance, 0.1f);
  EXPECT_EQ(ViewComparison(view).compare(other.values.data(), 0.9f * agreement.distance).distance, 2.0f);
  EXPECT_EQ(ViewComparison(view).compare(other.values.data(), 1.1f * agreement.distance).distance, agreement.distance);
}

TEST(ViewSignature, RefusesWhatCannotBeSeen) {
  const Points points = slabWithTower(1.0, 0.6);
  EXPECT_THROW(viewOf(Points(3, 0), {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewOf(Points(Points::Ones(3, 10)), {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewOf(points, Eigen::Vector3d::Zero()), std::invalid_argument);
  Points line = Points::Zero(3, 10);
  line.row(2).setLinSpaced(0.0f, 1.0f);
  EXPECT_THROW(viewOf(line, {0, 0, 1}), std::invalid_argument);
  Points bad = points;
  bad(1, 7) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(viewOf(bad, {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewsAround(points, 0), std::invalid_argument);
}

TEST(ViewIndex, FindsTheShapeAndItsPose) {
  ViewIndex index;
  const Points shape = slabWithTower(1.0, 0.6);
  index.add(viewsAround(slabWithTower(2.0, 0.2)));
  index.add(viewsAround(shape));
  index.add(viewsAround(slabWithTower(0.6, 1.2)));
  const Eigen::Isometry3d T_scan_shape = motion(1.3, {1.0, -0.4, 0.3}, {2.0, 0.0, 1.0});
  const View scan = viewOf(moved(shape, T_scan_shape), {0.3, -1.0, 0.6});
  const std::vector<ShapeOfView> found = index.nearest(scan);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found.front().shape, 1);
  EXPECT_LT(found.front().distance, found[1].distance);
  double least = M_PI;
  for (const Eigen::Isometry3d& pose : found.front().T_shape_scan)
    least = std::min(least, angleBetween(pose, T_scan_shape.inverse()));
  EXPECT_LT(least, 0.35);  // views are 20 degrees apart
}

TEST(ViewIndex, AsksForNoMoreThanItHolds) {
  ViewIndex index;
  const View view = viewOf(slabWithTower(1.0, 0.6), {0, 0, 1});
  EXPECT_TRUE(index.nearest(view).empty());
  index.add({});
  EXPECT_TRUE(index.nearest(view).empty());
  index.add({view});
  ViewSearchOptions options;
  EXPECT_EQ(index.nearest(view, options).size(), 1u);
  options.num_nearest = 0;
  EXPECT_TRUE(index.nearest(view, options).empty());
}

TEST(ViewIndex, AnyNumberOfThreadsGivesTheSame) {
  ViewIndex index;
  for (int i = 0; i < 20; ++i) index.add(viewsAround(slabWithTower(0.5 + 0.1 * i, 0.6), 10, 1));
  const View scan = viewOf(slabWithTower(1.07, 0.6), {0.3, -1.0, 0.6});
  ViewSearchOptions options;
  options.num_threads = 1;
  const std::vector<ShapeOfView> one = index.nearest(scan, options);
  options.num_threads = 8;
  const std::vector<ShapeOfView> many = index.nearest(scan, options);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].shape, many[i].shape);
    EXPECT_EQ(one[i].distance, many[i].distance);
  }
}

}  // namespace
}  // namespace pcl_symmetry
