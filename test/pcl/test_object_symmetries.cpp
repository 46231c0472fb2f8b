#include "pcl_symmetry/object_symmetries.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"
#include "shapes/scans.h"
#include "shapes/threads.h"
#include "shapes/turning_shapes.h"

namespace pcl_symmetry {
namespace {

void expectSame(const ObjectSymmetries& a, const ObjectSymmetries& b) {
  EXPECT_EQ(a.name(), b.name());
  EXPECT_EQ(test::matricesOf(a.discrete), test::matricesOf(b.discrete));
}

TEST(DetectObjectSymmetries, OfACloudAreThoseOfItsFinitePoints) {
  const test::Shape shape = test::moved(test::box(1500, test::Sampling::Random, 1), test::randomPose(1));
  ObjectSymmetryOptions options;  // coarse: sanitizers make it slow
  options.num_cells = 32;
  options.num_directions = 1000;
  const ObjectSymmetries expected = objectSymmetries(shape.cloud(), options);
  EXPECT_EQ(expected.name(), "D2");
  expectSame(detectObjectSymmetries(*test::toCloud(shape), options), expected);
  expectSame(detectObjectSymmetries(*test::toCloud<pcl::PointXYZRGB>(shape), options), expected);
  expectSame(detectObjectSymmetries(*test::withHoles(*test::toCloud(shape), 5), options), expected);
}

TEST(DetectObjectSymmetries, OfAMeshDoNotDependOnItsVertices) {
  test::TurningShape shape = test::propellerShape(3, true);
  // A corner of the first blade where all vertices but it are left alone.
  shape.vertices.insert(shape.vertices.end(), 5000, shape.vertices.front());
  const ObjectSymmetries found = detectObjectSymmetries(test::toMesh(shape.corners().cast<float>(), shape.triangles));
  EXPECT_EQ(found.name(), "C3");
  EXPECT_EQ(found.discrete.size(), 2u);
}

TEST(DetectObjectSymmetries, AreTheIdentityAloneWhereThereIsNoAnswer) {
  for (const auto& [name, cloud] : test::cloudsWithoutAnswer()) {
    if (!cloud) continue;
    const ObjectSymmetries none = detectObjectSymmetries(*cloud);
    EXPECT_EQ(none.name(), "C1") << name;
    EXPECT_EQ(none.confidence, 0.0) << name;
    EXPECT_NE(none.reason, "") << name;
  }
  EXPECT_NE(detectObjectSymmetries(pcl::PolygonMesh()).reason, "");
}

TEST(DetectObjectSymmetries, AScanFromOneSideHasNone) {
  const ObjectSymmetries none = detectObjectSymmetries(*test::pictureOf(test::scan(test::blockBox(), {3.5, 4.2, 2.9})));
  EXPECT_EQ(none.name(), "C1");
  EXPECT_EQ(none.confidence, 0.0);
  EXPECT_NE(none.reason.find("one side"), std::string::npos) << none.reason;
}

}  // namespace
}  // namespace pcl_symmetry
