#include "pcl_symmetry/symmetry_detection.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"
#include "shapes/found_planes.h"

namespace pcl_symmetry {
namespace {

using test::expectSamePlanes;
using test::numFound;
using test::Sampling;

TEST(DetectSymmetryPlanes, LeavesOutWhatIsOnlyPossible) {
  DetectionOptions options;
  options.min_confidence = 0.99999;
  const auto cloud = test::toCloud(test::box(2000, Sampling::Random, 3));
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options);
  refinement.setInputCloud(cloud);
  const std::vector<SymmetryPlane> planes = refinement.compute();
  ASSERT_EQ(planes.size(), 3u);
  for (const SymmetryPlane& plane : planes) EXPECT_EQ(plane.kind, PlaneKind::Possible);
  EXPECT_TRUE(detectSymmetryPlanes(*cloud, options).empty());
}

TEST(DetectSymmetryPlanes, WorksOnEveryPointTypeAlike) {
  const auto shape = test::box(2000, Sampling::Random, 3);
  const auto expected = detectSymmetryPlanes(*test::toCloud<pcl::PointXYZ>(shape));
  EXPECT_EQ(expected.size(), 3u);
  EXPECT_EQ(numFound(shape, expected, 1.0 * test::kDegree, 0.02), 3);
  expectSamePlanes(detectSymmetryPlanes(*test::toCloud<pcl::PointXYZRGB>(shape)), expected);
  expectSamePlanes(detectSymmetryPlanes(*test::toCloud<pcl::PointNormal>(shape)), expected);
}

TEST(DetectSymmetryPlanes, TakesMeshes) {
  const auto planes = detectSymmetryPlanes(test::boxMesh(), {}, 2000);
  EXPECT_EQ(numFound(test::box(100, Sampling::Mirrored, 1), planes, 1.0 * test::kDegree, 0.02), 3);
}

}  // namespace
}  // namespace pcl_symmetry
