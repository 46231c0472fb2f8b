/// The refinement as published: closed form, constant width, regions that may not be left, nothing added.
#include "pcl_symmetry/core/published_planes.h"

#include <gtest/gtest.h>

#include "core/base/constants.h"
#include "shapes/found_planes.h"
#include "shapes/threads.h"

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
  options.num_points = 1000;
  options.max_maxima = 12;
  const test::Shape box = test::moved(test::box(1, test::Sampling::Random, 4), pose);
  for (const auto method : {TransformMethod::Sampled, TransformMethod::Voting}) {  // exact maps: below
    const auto planes = publishedPlanes(points, edt, publishedMap(points, edt, method), options);
    for (const ReflectionPlane& plane : box.planes)
      EXPECT_TRUE(test::isAmong(planes, plane, kDegree, 0.02, pose.translation())) << static_cast<int>(method);
  }
}

TEST(PublishedPlanes, AreNotLostAtBordersOfCells) {
  // A cube, turned by three tenths of a bin of phi and of theta at a time, three bins in all: its planes cross all
  // borders of their cells, and stand at each tenth of them once.
  const test::Shape cube = test::cube(3000, test::Sampling::Random, 4);
  PublishedOptions options;
  options.num_points = 500;
  options.max_maxima = 20;
  for (int i = 0; i < 10; ++i) {
    const double bins = 0.3 * i / 64.0;
    const Eigen::Isometry3d pose = Eigen::AngleAxisd(2.0 * kPi * bins, Eigen::Vector3d::UnitZ()) *
                                   Eigen::Isometry3d(Eigen::AngleAxisd(0.5 * kPi * bins, Eigen::Vector3d::UnitX()));
    const test::Shape turned = test::moved(cube, pose);
    const Points points = turned.cloud();
    const GaussianEdt edt(points);
    const auto method = i == 5 ? TransformMethod::Convolution : TransformMethod::Sampled;  // exact maps take longer
    const auto planes = publishedPlanes(points, edt, publishedMap(points, edt, method), options);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_TRUE(
          test::isAmong(planes, ReflectionPlane(pose.linear().col(axis), 0.0), kDegree, 0.02, Eigen::Vector3d::Zero()))
          << i << ": " << axis;
  }
}

TEST(PublishedPlanes, ConvergeInTheirRegionsAndAreNotJudged) {
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
    EXPECT_TRUE(plane.converged);
    EXPECT_EQ(plane.kind, PlaneKind::Approximate);
    EXPECT_EQ(plane.confidence, 0.0);
    for (const double unmeasured : {plane.share, plane.share_low, plane.share_high, plane.deviation})
      EXPECT_TRUE(std::isnan(unmeasured));
  }
}

TEST(PublishedPlanes, AreTheSameForAnyNumberOfThreads) {
  const Points points = boxCloud();
  const GaussianEdt edt(points);
  const SymmetryMap map = publishedMap(points, edt, TransformMethod::Sampled);
  const auto planes = [&](int num_threads) {
    PublishedOptions options;
    options.num_threads = num_threads;
    options.num_points = 200;
    options.max_maxima = 12;
    return publishedPlanes(points, edt, map, options);
  };
  test::compareThreads(planes, test::expectSamePlanes);
}

}  // namespace
