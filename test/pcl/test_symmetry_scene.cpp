/// The class of scenes, and parts of a frame; what its objects are is tested through the tool.
#include "pcl_symmetry/symmetry_scene.h"

#include <gtest/gtest.h>
#include <pcl/common/point_tests.h>

#include "pcl/clouds.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "shapes/found_planes.h"

namespace pcl_symmetry {
namespace {

using Cloud = SymmetryScene::Cloud;
using test::pictureOf;

/// Two boxes apart, with room between them in the picture.
const test::Table& twoBoxes() {
  static const test::Table table({{-0.35, 0.1, 0.0}, {0.25, 0.0, 0.0}});
  return table;
}

/// The errors of structured light: 1.4 mm at 1 m, growing with the square of the depth.
Cloud::Ptr withDepthErrors(const test::Scan& scan) {
  RandomStream random(5);
  Cloud::Ptr cloud = pictureOf(scan);
  for (pcl::PointXYZ& point : *cloud) {
    if (!pcl::isXYZFinite(point)) continue;
    const Eigen::Vector3d x = point.getVector3fMap().cast<double>();
    const double depth = (scan.T_camera_object * x).z();
    point.getVector3fMap() =
        (scan.viewpoint + (1.0 + 1.4e-3 * depth * test::gaussian(random)) * (x - scan.viewpoint)).cast<float>();
  }
  return cloud;
}

TEST(WithoutDepthErrors, LeavesExactAndUnorganizedFramesAsTheyAre) {
  const Cloud::ConstPtr exact = pictureOf(twoBoxes().scan);
  EXPECT_EQ(withoutDepthErrors(exact, SeenSpace(*exact)), exact);
  auto row = pcl::make_shared<Cloud>(*withDepthErrors(twoBoxes().scan));
  row->width = static_cast<std::uint32_t>(row->size());
  row->height = 1;
  EXPECT_EQ(withoutDepthErrors(row, SeenSpace()), Cloud::ConstPtr(row));
  EXPECT_EQ(withoutDepthErrors(nullptr, SeenSpace()), nullptr);
}

/// The planes of a part of a frame.
SymmetryMaximaRefinement<pcl::PointXYZ> ofBox(const Cloud::ConstPtr& frame, int box) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(frame);
  refinement.setIndices(pcl::make_shared<pcl::Indices>(twoBoxes().pixelsOf(box)));
  return refinement;
}

TEST(StandingInScene, APartOfAFrameKnowsTheTableThatItStandsOn) {
  const Cloud::ConstPtr frame = pictureOf(twoBoxes().scan);
  const SeenSpace seen = detail::standingInScene(SeenSpace(*frame), frame, twoBoxes().pixelsOf(1), 0.01);
  ASSERT_NE(seen.visibility(), nullptr);
  ASSERT_EQ(seen.visibility()->supports().size(), 1u);
  EXPECT_LT((seen.visibility()->supports()[0].head<3>() - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
}

TEST(StandingInScene, WhatStandsAloneKnowsItsTableToo) {
  const test::Table table({{0.0, 0.0, 0.0}, {-0.15, 0.35, 0.0}});  // the second box is within the first
  const Cloud::ConstPtr frame = pictureOf(table.scan);
  const SeenSpace seen = detail::standingInScene(SeenSpace(*frame), frame, table.pixelsOf(1), 0.01);
  ASSERT_NE(seen.visibility(), nullptr);
  EXPECT_EQ(seen.visibility()->supports().size(), 1u);
}

TEST(WithoutDepthErrors, IsWhatPartsOfAFrameDoThemselves) {
  const Cloud::ConstPtr noisy = withDepthErrors(twoBoxes().scan);
  auto own = ofBox(noisy, 1), shared = ofBox(withoutDepthErrors(noisy, SeenSpace(*noisy)), 1);
  const std::vector<SymmetryPlane> planes = own.compute(), of_filtered = shared.compute();
  EXPECT_LT(own.getUsedIndices().size(), twoBoxes().pixelsOf(1).size()) << "pixels that fly are left out";
  test::expectSamePlanes(planes, of_filtered);
  own.setAsPublished(true);
  own.compute();
  EXPECT_EQ(own.getUsedIndices().size(), twoBoxes().pixelsOf(1).size()) << "the paper leaves them in";
}

TEST(SymmetryScene, DataWithoutAnswerGiveNoObject) {
  for (const auto& [name, cloud] : test::cloudsWithoutAnswer()) {
    SymmetryScene scene;
    scene.setInputCloud(cloud);
    const SceneAnalysis found = scene.compute();
    EXPECT_TRUE(found.objects.empty()) << name;
    EXPECT_TRUE(!found.reason.empty() || cloud->size() >= static_cast<std::size_t>(SceneOptions().min_points)) << name;
  }
  EXPECT_EQ(SymmetryScene().compute().reason, "not set");
}

/// The handle is at the back of a side that the camera does not see, in a depth 0.15 beyond the edge that it seems to
/// border.
TEST(SymmetryScene, AHandleBelongsToTheBodyThatHidesItsEnds) {
  const test::Block table{{0.0, 0.0, -0.02}, {0.7, 0.7, 0.02}}, body{{0.0, 0.1, 0.12}, {0.2, 0.1, 0.12}},
      handle{{0.22, 0.17, 0.12}, {0.04, 0.015, 0.05}};
  const test::BlockObject without{{table, body}, {}}, with{{table, body, handle}, {}};
  const Eigen::Vector3d viewpoint(0.1, -1.6, 1.0);
  const auto pixelsOfObject = [](const Cloud::ConstPtr& cloud) {
    SymmetryScene scene;
    scene.setInputCloud(cloud);
    const SceneAnalysis found = scene.compute();
    EXPECT_EQ(found.objects.size(), 1u);
    return found.objects.empty() ? pcl::Indices() : found.objects[0].indices;
  };
  const auto pictureWith = [&](const test::BlockObject& blocks) {
    return pictureOf(test::scan(blocks, viewpoint, 0.0, 640, 480));
  };
  const Cloud::Ptr frame = pictureWith(with);
  EXPECT_GT(pixelsOfObject(frame).size(), pixelsOfObject(pictureWith(without)).size() + 50);
  frame->width = static_cast<std::uint32_t>(frame->size());
  frame->height = 1;
  EXPECT_FALSE(pixelsOfObject(frame).empty()) << "without a picture, it is left out, and no object of its own";
}

TEST(SymmetryScene, RefusesBadOptions) {
  SymmetryScene scene;
  SceneOptions options;
  options.min_points = 3;
  EXPECT_EQ(test::messageOf([&] { scene.setOptions(options); }), "min_points = 3, must be >= 20");
  EXPECT_EQ(scene.getOptions().min_points, SceneOptions().min_points) << "as before";
  EXPECT_EQ(test::messageOf([&] { scene.setGround(Eigen::Vector4d(0.0, 0.0, 0.0, 1.0)); }),
            "ground: must be four finite numbers A,B,C,D, not all of A, B, C zero");
}

}  // namespace
}  // namespace pcl_symmetry
