/// Where the scanner stood: told by the rays of an organized cloud, by sensor_origin_, or by the user.
#include "pcl_symmetry/viewpoint.h"

#include <gtest/gtest.h>
#include <pcl/common/transforms.h>

#include "pcl/clouds.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "shapes/found_planes.h"

namespace pcl_symmetry {
namespace {

using test::isAmong;
using test::messageOf;
using test::pictureOf;
using test::Sampling;
using test::Scan;
using test::toCloud;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// A box seen from a random side that shows three faces (one alone fits many cameras), with a random roll.
Scan randomScan(std::uint64_t seed) {
  RandomStream random(seed, 21);
  Eigen::Vector3d from;
  for (int axis = 0; axis < 3; ++axis)
    from[axis] = (random.uniform() < 0.5 ? -1.0 : 1.0) * (1.6 + 2.0 * random.uniform());
  return test::scan(test::blockBox(), from, 6.0 * random.uniform());
}

TEST(SeenByOrganizedCloud, TheRaysAreThoseOfItsCamera) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scan scan = randomScan(seed);
    const auto seen = detail::seenByOrganizedCloud(*pictureOf(scan));
    ASSERT_TRUE(seen) << seed;
    const Visibility truth = scan.visibility();
    EXPECT_EQ(seen->width(), scan.width);
    RandomStream random(seed);
    int num_same = 0;
    constexpr int kTrials = 5000;
    for (int i = 0; i < kTrials; ++i) {
      const Eigen::Vector3d x = 1.3 * test::randomPoint(random);
      num_same += (seen->depthBehind(x) < 0.0) == (truth.depthBehind(x) < 0.0) ? 1 : 0;
    }
    EXPECT_GT(num_same, 0.99 * kTrials) << seed << ": all but those at the borders of pixels";
    for (int i = 0; i < scan.pixels.cols(); i += 7) {
      const int u = i % scan.width, v = i / scan.width;
      if (!scan.pixels.col(i).allFinite()) continue;
      ASSERT_NEAR(seen->depth(u, v), truth.depth(u, v), 0.02) << seed;
    }
  }
}

TEST(SeenByOrganizedCloud, OfATableAloneTheCameraIsThatOfItsFrame) {
  Cloud table(64, 48, pcl::PointXYZ(NAN, NAN, NAN));
  const Eigen::Vector3f up = Eigen::Vector3f(0.0f, -0.8f, -0.6f);
  for (int v = 10; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const Eigen::Vector3f ray((u - 30.0f) / 55.0f, (v - 25.0f) / 55.0f, 1.0f);
      table(u, v).getVector3fMap() = -0.6f / up.dot(ray) * ray;
    }
  const auto seen = detail::seenByOrganizedCloud(table);
  ASSERT_TRUE(seen) << "many cameras see one plane so";
  EXPECT_LT(seen->viewpoint().norm(), 1e-3);
  for (pcl::PointXYZ& point : table) point.z += 1.0f;
  EXPECT_FALSE(detail::seenByOrganizedCloud(table)) << "moved, it does not tell";
}

TEST(ScanAnalysis, UsesAViewpointThatIsGiven) {
  const Scan scan = test::scan(test::blockBox(), {2.5, -3.0, 2.0});
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(toCloud(scan.cloud()));
  EXPECT_EQ(refinement.getViewpointSource(), ViewpointSource::None) << "before the analysis";
  refinement.compute();
  EXPECT_NE(refinement.getViewpointSource(), ViewpointSource::Given);
  EXPECT_EQ(refinement.usedViewpoint(), refinement.getUsedViewpoint().has_value());
  refinement.setViewpoint(scan.viewpoint);
  const auto planes = refinement.compute();
  EXPECT_EQ(refinement.getViewpointSource(), ViewpointSource::Given);
  ASSERT_TRUE(refinement.getUsedViewpoint());
  EXPECT_LT((*refinement.getUsedViewpoint() - scan.viewpoint).norm(), 1e-9);
  for (const ReflectionPlane& plane : scan.planes)
    EXPECT_TRUE(isAmong(planes, plane, 2.0 * test::kDegree, 0.05, Eigen::Vector3d::Zero()))
        << plane.normal().transpose();
  // A viewpoint among the points is none.
  refinement.setViewpoint(Eigen::Vector3d::Zero());
  EXPECT_NE(messageOf([&] { refinement.compute(); }).find("viewpoint"), std::string::npos);
  const Viewpoint nowhere{Viewpoint::Mode::Given, Eigen::Vector3d::Constant(std::nan(""))};
  EXPECT_EQ(messageOf([&] { refinement.setViewpoint(nowhere); }), "viewpoint = nan nan nan, must be finite");
  EXPECT_EQ(messageOf([&] { SeenSpace(Cloud(), nowhere); }), "viewpoint = nan nan nan, must be finite");
}

TEST(ScanAnalysis, StrayPointsDoNotMoveTheViewpoint) {
  const Scan scan = test::scan(test::blockBox(), {2.5, -3.0, 2.0});
  const auto cloud = toCloud(scan.cloud());
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  const std::size_t num_planes = refinement.compute().size();
  const std::optional<Eigen::Vector3d> viewpoint = refinement.getUsedViewpoint();
  ASSERT_TRUE(viewpoint);
  const Eigen::Vector3f behind = 4.0f * scan.viewpoint.cast<float>();  // the sensor
  cloud->push_back(pcl::PointXYZ(behind.x(), behind.y(), behind.z()));
  refinement.setInputCloud(cloud);
  EXPECT_EQ(refinement.compute().size(), num_planes);
  EXPECT_EQ(refinement.getUsedViewpoint(), viewpoint);
  refinement.setViewpoint(scan.viewpoint);
  EXPECT_GE(refinement.compute().size(), num_planes) << "it does not have to see the point";
}

/// The part of the first box's far side that the second box hides.
int numTakenForFree(const SeenSpace& seen, const test::Table& table) {
  const Visibility truth = table.scan.visibility();
  const test::Block& box = table.blocks.blocks[1];
  RandomStream random(1);
  int num_free = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d x = box.center + 1.2 * box.half.cwiseProduct(test::randomPoint(random));
    if (truth.depthBehind(x) > 0.1) num_free += seen.visibility()->depthBehind(x) < 0.0 ? 1 : 0;
  }
  return num_free;
}

TEST(SeenSpace, IndicesNameAPartOfWhatTheScannerSaw) {
  const test::Table table;
  auto whole = toCloud(table.scan.cloud());
  whole->sensor_origin_.head<3>() = table.scan.viewpoint.cast<float>();
  // The pixels of the box, counted among those that met something.
  auto indices = pcl::make_shared<pcl::Indices>();
  pcl::index_t at = 0;
  for (std::size_t i = 0; i < table.ids.size(); ++i) {
    if (table.ids[i] == 1) indices->push_back(at);
    if (table.scan.pixels.col(static_cast<Eigen::Index>(i)).allFinite()) ++at;
  }
  const Cloud alone(*whole, *indices);  // with its origin
  const Points points = detail::selectPoints(alone, nullptr, alone.size(), 0).points;
  const SeenSpace before = detail::findSeenSpace(alone, points, Viewpoint{});
  const SeenSpace after = detail::findSeenSpace(*whole, points, Viewpoint{}, true);
  ASSERT_TRUE(before.visibility() && after.visibility());
  EXPECT_EQ(after.source(), ViewpointSource::Stored);
  EXPECT_GT(numTakenForFree(before, table), 50);
  EXPECT_LT(numTakenForFree(after, table), 5);

  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setMaxPoints(1000);
  refinement.setInputCloud(whole);
  refinement.setIndices(indices);
  const std::vector<SymmetryPlane> own = refinement.compute();
  EXPECT_EQ(refinement.getViewpointSource(), ViewpointSource::Stored);
  refinement.setSeenSpace(std::make_shared<const SeenSpace>(*whole));
  const std::vector<SymmetryPlane> shared = refinement.compute();
  test::expectSamePlanes(own, shared);  // what is made once is what each analysis makes
}

TEST(SeenSpace, AScannerAtTheOriginOfItsSceneIsBelieved) {
  const test::Table table;
  auto cloud = toCloud(table.scan.cloud());
  pcl::transformPointCloud(*cloud, *cloud, table.scan.T_camera_object.cast<float>().matrix());
  EXPECT_EQ(SeenSpace(*cloud).source(), ViewpointSource::Stored);
  EXPECT_EQ(SeenSpace(*pictureOf(table.scan)).source(), ViewpointSource::Rays);
  EXPECT_EQ(SeenSpace(*cloud, {Viewpoint::Mode::None, {}}).visibility(), nullptr);
  EXPECT_EQ(SeenSpace(*cloud, {Viewpoint::Mode::Given, {0.0, 0.0, -0.1}}).source(), ViewpointSource::Given);
  EXPECT_EQ(SeenSpace(Cloud()).visibility(), nullptr);
  const Cloud one(1, 1, pcl::PointXYZ(0.0f, 0.0f, 0.0f));
  EXPECT_THROW(SeenSpace(one, {Viewpoint::Mode::Given, Eigen::Vector3d::Zero()}), pcl::BadArgumentException);
}

TEST(SeenSpace, AWholeObjectIsNoScene) {
  EXPECT_EQ(SeenSpace(*toCloud(test::box(4000, Sampling::Random, 1))).visibility(), nullptr);
}

TEST(SeenSpace, ScannersTellMoreTogether) {
  const test::Table table;
  const auto one = pictureOf(table.scan), two = pictureOf(test::scan(table.blocks, {-0.3, 1.7, 0.9}, 0.0, 320, 240));
  const SeenSpace both = SeenSpace::together({SeenSpace(*one), SeenSpace(), SeenSpace(*two)});
  ASSERT_TRUE(both.visibility());
  EXPECT_EQ(both.visibility()->numPictures(), 2u);
  EXPECT_EQ(SeenSpace::together({}).visibility(), nullptr);
}

}  // namespace
}  // namespace pcl_symmetry
