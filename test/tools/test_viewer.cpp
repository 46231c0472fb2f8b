#include <gtest/gtest.h>

#include <set>

#include "pcl/pcl_meshes.h"
#include "pictures/raster_image.h"
#include "tools/models.h"
#include "tools/tool_run.h"
#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using pcl_symmetry::test::boxMesh;

ViewerState stateWith(int num_planes) {
  ViewerState state;
  state.num_planes = num_planes;
  state.has_mesh = true;
  state.camera = CameraMove::Stay;
  return state;
}

TEST(ViewerKeys, DoWhatTheHelpSays) {
  ViewerState state = stateWith(3);
  pressKey(state, "n");
  EXPECT_EQ(state.plane, 1);
  pressKey(state, "b");
  pressKey(state, "Left");
  EXPECT_EQ(state.plane, 2) << "round";
  pressKey(state, "Right");
  EXPECT_EQ(state.plane, 0);
  const auto toggles = [&](const char* key, bool ViewerState::*field) {
    const bool before = state.*field;
    pressKey(state, key);
    EXPECT_NE(state.*field, before) << key;
    pressKey(state, key);
    EXPECT_EQ(state.*field, before) << key;
  };
  toggles("g", &ViewerState::patch);
  toggles("s", &ViewerState::support);
  toggles("o", &ViewerState::reflection);
  toggles("a", &ViewerState::axes);
  toggles("m", &ViewerState::mesh);
  toggles("c", &ViewerState::parts);
  toggles("h", &ViewerState::help);
  pressKey(state, "i");
  pressKey(state, "i");
  EXPECT_EQ(state.step, 1);
  pressKey(state, "u");
  EXPECT_EQ(state.step, 0);
  pressKey(state, "n");
  EXPECT_EQ(state.step, -1) << "of another plane";
  pressKey(state, "w");
  EXPECT_EQ(state.camera, CameraMove::Worst);
  pressKey(state, "v");
  EXPECT_EQ(state.camera, CameraMove::Best);
  pressKey(state, "e");
  EXPECT_EQ(state.camera, CameraMove::Along);
  pressKey(state, "p");
  EXPECT_TRUE(state.save);
  EXPECT_FALSE(state.quit);
  pressKey(state, "Escape");
  EXPECT_TRUE(state.quit);
  EXPECT_FALSE(pressKey(state, "F7"));
}

/// The box as loadShape() gives it.
Shape loadedBox(const Eigen::Vector3f& center) {
  Shape shape;
  shape.mesh = boxMesh({2.0f, 3.0f, 4.0f}, center);
  shape.cloud = shape.mesh->cloud;
  shape.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::fromPCLPointCloud2(shape.cloud, *shape.points);
  return shape;
}

TEST(ViewerModel, IsOfUnitSizeAboutTheOriginWithItsPlanes) {
  ViewerModelOptions options;
  const Eigen::Vector3f center(40, -30, 20);
  const ViewerModel model = makeViewerModel(loadedBox(center), options);
  ASSERT_EQ(model.planes.size(), 3u);
  EXPECT_EQ(model.labels.size(), 3u);
  Eigen::AlignedBox3d box;
  for (const pcl::PointXYZ& point : *model.points) box.extend(point.getVector3fMap().cast<double>());
  for (const SymmetryPlane& plane : model.planes) {
    EXPECT_LT(std::abs(plane.signedDistance(box.center())), 0.005) << "through the middle of the box";
    EXPECT_EQ(plane.point_support.size(), model.points->size());
  }
  float farthest = 0.0f;
  for (const pcl::PointXYZ& point : *model.points) farthest = std::max(farthest, point.getVector3fMap().norm());
  EXPECT_NEAR(farthest, 1.0f, 0.02f);
}

TEST(ViewerModel, IsCutIntoPartsOfTheMeshOrOfTheCloud) {
  ViewerModelOptions options;
  options.num_parts = 2;
  Shape shape = loadedBox(Eigen::Vector3f::Zero());
  ViewerModel model = makeViewerModel(shape, options);
  EXPECT_EQ(findParts(model).size(), model.mesh->polygons.size());
  shape.points = model.points;
  shape.mesh.reset();
  model = makeViewerModel(shape, options);
  const std::vector<int> parts = findParts(model);
  EXPECT_EQ(parts.size(), model.points->size());
  EXPECT_EQ(std::set<int>(parts.begin(), parts.end()), (std::set<int>{0, 1}));
}

class ViewerTool : public ToolTest {
protected:
  ViewerTool() : ToolTest("env -u DISPLAY " + toolPath("viewer")) {}

  const std::string mesh_ = folder_.write("box.off", boxOFF(1.4));
};

TEST_F(ViewerTool, MakesPicturesWithoutAScreen) {
  const std::string common = mesh_ + " -quiet -symmetries -width 320 -height 240 -screenshot ";
  ASSERT_EQ(run(common + (folder_ / "a.png")), 0) << error_;
  ASSERT_EQ(run(common + (folder_ / "b.png") + " -keys n,o,h"), 0) << error_;
  ASSERT_EQ(run(common + (folder_ / "c.png") + " -keys i,i"), 0) << error_;
  ASSERT_EQ(run(common + (folder_ / "d.png") + " -keys c -parts 2"), 0) << error_;
  const RasterImage a = readImage(folder_ / "a.png"), b = readImage(folder_ / "b.png"),
                    c = readImage(folder_ / "c.png"), d = readImage(folder_ / "d.png");
  EXPECT_EQ(a.width, 320);
  EXPECT_EQ(a.height, 240);
  EXPECT_NE(a.pixels, b.pixels);
  EXPECT_NE(a.pixels, c.pixels);
  EXPECT_NE(a.pixels, d.pixels);
}

TEST_F(ViewerTool, SaysWhyThereIsNoWindow) {
  EXPECT_TRUE(fails(mesh_, 1, "there is no display"));
  EXPECT_NE(error_.find("-screenshot FILE needs none"), std::string::npos);
  EXPECT_TRUE(fails(mesh_ + " -screenshot " + (folder_ / "a.png") + " -keys F7", 2, "there is no key F7"));
}

}  // namespace
