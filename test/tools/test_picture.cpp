#include <gtest/gtest.h>

#include <cstdlib>

#include "tools/box_mesh.h"
#include "tools/display.h"
#include "tools/temporary_folder.h"
#include "pictures/picture.h"
#include "scanner/virtual_scanner.h"

namespace {

using namespace pcl_symmetry::apps;

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
  const std::string png = contentOf(folder / "box.png");
  ASSERT_GT(png.size(), 2000u) << "a blank picture of this size compresses to less";
  EXPECT_EQ(png.substr(1, 3), "PNG");
  const auto bigEndian = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<unsigned char>(png[i]);
    return value;
  };
  EXPECT_EQ(bigEndian(16), 300);
  EXPECT_EQ(bigEndian(20), 200);
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
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
  EXPECT_THROW(renderPicture(std::vector<PictureScene>{}, folder / "none.png", 300, 200), std::invalid_argument);
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

TEST_F(Picture, RefusesScenesThatDoNotFitTogether) {
  const TemporaryFolder folder;
  const auto refused = [&](auto change) {
    PictureScene scene = boxScene();
    change(scene);
    EXPECT_THROW(renderPicture(scene, folder / "a.png", 100, 100), std::invalid_argument);
  };
  refused([](PictureScene& scene) { scene.points.reset(); });
  refused([](PictureScene& scene) { scene.panels.clear(); });
  refused([](PictureScene& scene) { scene.panels[0].support.pop_back(); });
  refused([](PictureScene& scene) { scene.panels[0].planes[0].normal.setZero(); });
  refused([](PictureScene& scene) { scene.view = scene.up; });
  EXPECT_THROW(renderPicture(boxScene(), folder / "a.png", 0, 100), std::invalid_argument);
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

}  // namespace
