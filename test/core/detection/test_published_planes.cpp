/// The refinement as published: closed form, constant width, cells that may not be left, nothing added.
#include "pcl_symmetry/core/published_planes.h"

#include <gtest/gtest.h>

#include "core/base/constants.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

Points boxCloud() {
  return test::moved(test::box(8000, test::Sampling::Random, 4), test::randomPose(4)).cloud();
}

TEST(PublishedPlanes, FindTheThreePlanesOfABox) {
  const Points points = boxCloud();
  const Eigen::Isometry3d pose = test::randomPose(4);
  const GaussianEdt edt(points);
  PublishedOptions options;
  options.discard_unstable = false;
  options.num_points = 2000;
  const auto planes = publishedPlanes(points, edt, publishedMap(points, edt), options);
  for (int k = 0; k < 3; ++k) {
    double nearest = 90.0;
    for (const SymmetryPlane& plane : planes)
      if (std::abs(plane.signedDistance(pose.translation())) < 0.02)
        nearest = std::min(nearest, plane.angleTo(ReflectionPlane(pose.linear().col(k), 0.0)) / kDegree);
    EXPECT_LT(nearest, 1.0);
  }
}

TEST(PublishedPlanes, StayInTheirCellsAndAreNotJudged) {
  const Points points = boxCloud();
  const GaussianEdt edt(points);
  const SymmetryMap map = publishedMap(points, edt);
  PublishedOptions options;
  options.num_points = 500;
  const auto stable = publishedPlanes(points, edt, map, options);
  options.discard_unstable = false;
  const auto all = publishedPlanes(points, edt, map, options);
  EXPECT_EQ(all.size(), findLocalMaxima(map).size()) << "nothing is added or merged";
  EXPECT_LT(stable.size(), all.size());
  EXPECT_FALSE(stable.empty());
  for (const SymmetryPlane& plane : stable) {
    EXPECT_EQ(plane.kind, PlaneKind::Approximate);
    EXPECT_EQ(plane.confidence, 0.0);
  }
}

TEST(PublishedPlanes, AreTheSameForAnyNumberOfThreads) {
  const Points points = boxCloud();
  const GaussianEdt edt(points);
  PublishedOptions options;
  options.num_threads = 1;
  options.num_points = 200;
  const SymmetryMap map = publishedMap(points, edt, TransformMethod::Voting);
  const auto expected = publishedPlanes(points, edt, map, options);
  options.num_threads = 8;
  const auto found = publishedPlanes(points, edt, map, options);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].coefficients(), expected[i].coefficients());
}

TEST(PublishedOptions, NamesFieldValueAndRule) {
  PublishedOptions options;
  options.num_points = 3;
  EXPECT_THROW(options.validate(), std::invalid_argument);
}

}  // namespace
