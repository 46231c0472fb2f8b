/// Whether points were measured from a viewpoint.
#include "core/scan/single_view.h"

#include <gtest/gtest.h>

#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(SpaceSeenFrom, AcceptsTheTrueOneOfAScan) {
  const Points whole = sphere(20'000, 1).cloud();  // its normals are the points
  const Eigen::Vector3d far(0.5, -1.0, -5.0);
  EXPECT_TRUE(spaceSeenFrom(facing(whole, whole, far), far));
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockBox(), blockL(), blockChair()})
      EXPECT_TRUE(spaceSeenFrom(scan(object, viewpoint).cloud(), viewpoint)) << seed;
  }
}

TEST(SpaceSeenFrom, RefusesWholeObjectsFromAnywhere) {
  for (const Shape& shape : {box(10'000, Sampling::Random, 1), sphere(10'000, 2), scaleneTetrahedron(10'000, 3),
                             prism(6, 1000, Sampling::Random, 4)}) {
    const Points cloud = shape.cloud();
    EXPECT_FALSE(spaceSeenFrom(cloud, Eigen::Vector3d::Zero()));
    EXPECT_FALSE(spaceSeenFrom(cloud, centerOfMass(cloud)));
    for (const double distance : {0.3, 1.5, 3.0, 30.0, 1000.0}) {
      RandomStream random(7);
      for (int i = 0; i < 5; ++i)
        EXPECT_FALSE(spaceSeenFrom(cloud, centerOfMass(cloud) + distance * randomDirection(random)))
            << distance << ", " << i;
    }
  }
}

TEST(SpaceSeenFrom, RefusesThinObjectsFromAnywhere) {
  // 0.06 thick, a twentieth of the radius: less than hiddenShare() would notice. The points are 0.026 apart.
  const Points plate = box({1.0, 0.8, 0.03}, 10'000, Sampling::Random, 5).cloud();
  RandomStream random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d viewpoint = 3.0 * randomDirection(random);
    EXPECT_FALSE(spaceSeenFrom(plate, viewpoint)) << i;
    EXPECT_FALSE(spaceSeenFrom(plate * 1e6f, viewpoint * 1e6)) << i;
  }
}

TEST(SpaceSeenFrom, AcceptsNoisyScans) {
  const Eigen::Vector3d viewpoint(2.0, -3.0, 1.5);
  Points points = scan(blockChair(), viewpoint).cloud();
  RandomStream random(4);
  const double sigma = 0.005 * diagonal(points);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = (points.col(i).cast<double>() - viewpoint).normalized();
    points.col(i) += (sigma * gaussian(random) * ray).cast<float>();
  }
  EXPECT_TRUE(spaceSeenFrom(points, viewpoint));
}

TEST(LayeredShare, CountsLayers) {
  RandomStream random(6);
  Points points(3, 4000);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = Eigen::Vector3d(symmetric(random), symmetric(random), 0.0).cast<float>();
  const Eigen::Vector3d viewpoint(0.1, 0.2, 50.0);
  EXPECT_EQ(layeredShare(points, viewpoint), 0.0) << "a flat sheet";
  for (Eigen::Index i = 0; i < points.cols(); i += 2) points(2, i) = -0.5f;
  // Two layers of equal density: the next point in the picture is of the other one every second time. Its error is
  // that of 2000 throws, 0.011, and neighbors in pairs.
  EXPECT_NEAR(layeredShare(points, viewpoint), 0.5, 0.05);
  EXPECT_EQ(layeredShare(Points::Ones(3, 1), viewpoint), 0.0);
  EXPECT_EQ(layeredShare(Points::Ones(3, 10), viewpoint), 0.0) << "no extent";
}

}  // namespace
