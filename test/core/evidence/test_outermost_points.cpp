/// The last points of a cloud along a direction, against a look at all of them.
#include "core/evidence/outermost_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Distances of the points along a direction, as the class adds them up.
std::vector<float> distances(const Points& points, const Eigen::Vector3f& direction) {
  std::vector<float> along;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    along.push_back(direction.x() * points(0, i) + direction.y() * points(1, i) + direction.z() * points(2, i));
  return along;
}

std::vector<Points> clouds() {
  Points flat = sphere(3000, 4).cloud();
  flat.row(1).setZero();
  Points line = flat;
  line.row(2).setZero();
  return {sphere(8000, 1).cloud(),
          box({1.0, 0.2, 0.05}, 3000, Sampling::Random, 2).cloud(),
          sphere(5, 3).cloud(),
          flat,
          line,
          Points::Constant(3, 1, 0.5f)};
}

TEST(OutermostPoints, AreThoseOfALookAtAll) {
  RandomStream random(5);
  for (const Points& points : clouds()) {
    const OutermostPoints outermost(points);
    ASSERT_EQ(outermost.size(), points.cols());
    for (int draw = 0; draw < 50; ++draw) {
      const Eigen::Vector3f direction =
          Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random)).cast<float>();
      const std::vector<float> along = distances(points, direction);
      const auto last = std::max_element(along.begin(), along.end());
      EXPECT_EQ(outermost.last(direction), points.col(last - along.begin()));
      const float from = *last - 0.1f * direction.norm();
      std::vector<Eigen::Index> visited, expected;
      outermost.visitFrom(direction, from, [&](Eigen::Index i, float) { visited.push_back(i); });
      std::sort(visited.begin(), visited.end());
      for (std::size_t i = 0; i < along.size(); ++i)
        if (along[i] >= from) expected.push_back(static_cast<Eigen::Index>(i));
      EXPECT_EQ(visited, expected);
    }
  }
}

TEST(OutermostPoints, AreTheFirstOfSeveralAsFar) {
  Points points = Points::Zero(3, 4);
  points.row(0) << 0.0f, 1.0f, 1.0f, 0.5f;
  points.row(1) << 0.0f, -2.0f, 3.0f, 0.0f;
  EXPECT_EQ(OutermostPoints(points).last(Eigen::Vector3f::UnitX()), points.col(1));
}

}  // namespace
