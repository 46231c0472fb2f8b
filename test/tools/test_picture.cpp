/// Pictures and pages of shapes, and the viewer.
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "pcl/pcl_meshes.h"
#include "pictures/picture.h"
#include "pictures/raster_image.h"
#include "pictures/scene_page.h"
#include "scanner/virtual_scanner.h"
#include "shapes/temporary_folder.h"
#include "tools/models.h"
#include "tools/tool_run.h"
#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using pcl_symmetry::test::boxMesh;

/// Starts the test program again within xvfb-run where there is no display, as the tools do.
void findDisplayForTest() {
  if (std::getenv("DISPLAY")) return;
  std::vector<std::string> words = {"xvfb-run", "-a"};
  std::ifstream line("/proc/self/cmdline", std::ios::binary);
  for (std::string word; std::getline(line, word, '\0');) words.push_back(word);
  std::vector<char*> command;
  for (std::string& word : words) command.push_back(word.data());
  command.push_back(nullptr);
  ::execvp(command[0], command.data());
}

PictureScene boxScene() {
  const VirtualScanner scanner(boxMesh({0.5f, 0.8f, 1.2f}));
  PictureScene scene;
  scene.points = scanner.scan({1, 1, 1}).cloud;
  for (int k = 0; k < 3; ++k) {
    PicturePanel panel;
    panel.label = "plane " + std::to_string(k + 1);
    panel.support.assign(scene.points->size(), 0.5 * k);
    panel.planes.resize(1);
    panel.planes[0].normal = Eigen::Vector3d::Unit(k);
    scene.panels.push_back(panel);
  }
  return scene;
}

class Picture : public testing::Test {
protected:
  static void SetUpTestSuite() { findDisplayForTest(); }
};

TEST_F(Picture, IsAWholePNGOfTheWantedSize) {
  const TemporaryFolder folder;
  renderPicture(boxScene(), folder / "box.png", 300, 200);
  const RasterImage picture = readImage(folder / "box.png");
  EXPECT_EQ(picture.width, 300);
  EXPECT_EQ(picture.height, 200);
  EXPECT_GT(contentOf(folder / "box.png").size(), 2000u) << "a blank picture of this size compresses to less";
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST_F(Picture, HoldsSeveralScenes) {
  const TemporaryFolder folder;
  PictureScene other = boxScene();
  other.panels.resize(1);
  renderPicture({other}, folder / "one.png", 300, 200);
  renderPicture({other, other}, folder / "two.png", 300, 200, 1);
  renderPicture({other, other}, folder / "beside.png", 300, 200, 2);
  EXPECT_NE(contentOf(folder / "one.png"), contentOf(folder / "two.png"));
  EXPECT_NE(contentOf(folder / "two.png"), contentOf(folder / "beside.png"));
}

TEST_F(Picture, FailsWithOneErrorWhereNothingCanDraw) {
  const TemporaryFolder folder;
  const char* display = std::getenv("DISPLAY");
  const std::string old_display = display ? display : "", old_path = std::getenv("PATH");
  unsetenv("DISPLAY");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THROW(renderPicture(boxScene(), folder / "box.png", 300, 200), InputError);
  setenv("PATH", old_path.c_str(), 1);
  if (display) setenv("DISPLAY", old_display.c_str(), 1);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Cividis, RunsFromDarkBlueToYellow) {
  EXPECT_LT(cividis(0).sum(), 0.5);
  EXPECT_TRUE(cividis(1).isApprox(Eigen::Vector3d(255, 234, 70) / 255));
  EXPECT_EQ(cividis(-1), cividis(0));
  EXPECT_EQ(cividis(7), cividis(1));
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);
  for (double value = 0.02; value <= 1; value += 0.02) {
    EXPECT_GT(luminance.dot(cividis(value)), luminance.dot(cividis(value - 0.02)));
  }
}

PictureScene cloudScene(std::size_t num_points, int num_planes) {
  PictureScene scene;
  scene.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  std::mt19937 generator(1);
  std::normal_distribution<float> normal;
  for (std::size_t i = 0; i < num_points; ++i) {
    const Eigen::Vector3f p = Eigen::Vector3f(normal(generator), normal(generator), normal(generator)).normalized();
    points->emplace_back(p.x(), p.y(), p.z());
  }
  scene.points = points;
  for (int k = 0; k < num_planes; ++k) {
    PicturePanel panel;
    panel.label = "plane </script> " + std::to_string(k);
    panel.support.assign(num_points, 0.25 * k);
    panel.planes.resize(1);
    panel.axes.resize(1);
    scene.panels.push_back(panel);
  }
  return scene;
}

/// The JSON in a page.
nlohmann::json sceneOf(const std::string& page) {
  const std::string mark = "id=\"scene\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Bytes that a base64 text holds.
std::size_t numBytes(const std::string& text) {
  return text.size() / 4 * 3 - static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
}

TEST(ScenePage, HoldsEverythingInLittleRoom) {
  const TemporaryFolder folder;
  writePage(cloudScene(10'000, 4), {"a <b>", "table"}, folder / "a.html");
  const std::string page = contentOf(folder / "a.html");
  EXPECT_LT(page.size(), 1'500'000u);
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_NE(page.find("The MIT License"), std::string::npos) << "the license of three.js goes with it";
  for (const char* outside : {"src=", "href=", "@import", "fetch(\"http"})
    EXPECT_EQ(page.find(outside), std::string::npos) << "nothing comes from elsewhere";
  std::size_t scripts = 0;
  for (std::size_t at = page.find("</script>"); at != std::string::npos; at = page.find("</script>", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 3u) << "no label ends a script";
  const nlohmann::json scene = sceneOf(page);
  EXPECT_EQ(scene["title"], "a <b>");
  EXPECT_EQ(numBytes(scene["points"]), 120'000u);
  EXPECT_EQ(numBytes(scene["normals"]), 30'000u);
  ASSERT_EQ(scene["panels"].size(), 4u);
  EXPECT_EQ(scene["panels"][2]["label"], "plane </script> 2");
  EXPECT_EQ(numBytes(scene["panels"][2]["point_colors"]), 30'000u);
  EXPECT_EQ(scene["panels"][2]["planes"][0]["corners"].size(), 4u);
  EXPECT_EQ(scene["panels"][2]["axes"][0]["ends"].size(), 2u);
}

TEST(ScenePage, ThinsLargeCloudsAndLeavesOutWhatIsNotFinite) {
  const TemporaryFolder folder;
  PictureScene scene = cloudScene(450'000, 1);
  auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*scene.points);
  (*points)[0].x = std::numeric_limits<float>::quiet_NaN();
  scene.points = points;
  writePage(scene, {"a", ""}, folder / "a.html");
  EXPECT_EQ(numBytes(sceneOf(contentOf(folder / "a.html"))["points"]), 12u * 150'000) << "every third";
  scene.points.reset(new pcl::PointCloud<pcl::PointXYZ>(1, 1, {NAN, 0, 0}));
  scene.panels = {{}};
  EXPECT_THROW(writePage(scene, {"a", ""}, folder / "b.html"), InputError);
}

TEST(ScenePage, ShowsThePartsOfAMesh) {
  const TemporaryFolder folder;
  PictureScene scene;
  scene.mesh = boxMesh({1, 2, 3});
  scene.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  pcl::fromPCLPointCloud2(scene.mesh->cloud, *points);
  scene.points = points;
  PicturePanel panel;
  std::size_t num_triangles = 0;
  for (const pcl::Vertices& polygon : scene.mesh->polygons) {
    panel.segments.push_back(static_cast<int>(panel.segments.size()) % 3);
    num_triangles += polygon.vertices.size() - 2;
  }
  PicturePanel alone;
  for (const int segment : panel.segments) alone.segments.push_back(segment == 2 ? 2 : -1);
  scene.panels = {panel, alone};
  writePage(scene, {"box", ""}, folder / "a.html");
  const nlohmann::json page = sceneOf(contentOf(folder / "a.html"));
  EXPECT_EQ(numBytes(page["mesh"]), 36 * num_triangles);
  EXPECT_EQ(numBytes(page["panels"][0]["mesh_colors"]), 9 * num_triangles);
  EXPECT_EQ(page["panels"][0]["show_points"], false);
  EXPECT_EQ(page["panels"][0]["segments"].size(), 3u) << "a swatch for each";
  EXPECT_EQ(page["panels"][1]["segments"].size(), 1u);
}

TEST(ViewerKeys, DoWhatTheHelpSays) {
  ViewerState state;
  state.num_planes = 3;
  state.has_mesh = true;
  pressKey(state, "n");
  EXPECT_EQ(state.plane, 1);
  pressKey(state, "b");
  pressKey(state, "Left");
  EXPECT_EQ(state.plane, 2) << "round";
  pressKey(state, "Right");
  EXPECT_EQ(state.plane, 0);
  using Toggle = std::pair<const char*, bool ViewerState::*>;
  for (const auto& [key, field] :
       {Toggle("g", &ViewerState::patch), Toggle("s", &ViewerState::support), Toggle("o", &ViewerState::reflection),
        Toggle("a", &ViewerState::axes), Toggle("m", &ViewerState::mesh), Toggle("c", &ViewerState::parts),
        Toggle("h", &ViewerState::help)})
    for (const bool expected : {!(state.*field), state.*field}) {
      pressKey(state, key);
      EXPECT_EQ(state.*field, expected) << key;
    }
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
