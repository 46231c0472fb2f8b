#include <gtest/gtest.h>

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "tools/box_mesh.h"
#include "tools/temporary_folder.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry::apps;

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
  EXPECT_NE(page.find("The MIT License"), std::string::npos) << "the licence of three.js goes with it";
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
  scene.panels.clear();
  EXPECT_THROW(writePage(scene, {"a", ""}, folder / "b.html"), std::invalid_argument);
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
  scene.panels = {panel};
  writePage(scene, {"box", ""}, folder / "a.html");
  const nlohmann::json page = sceneOf(contentOf(folder / "a.html"));
  EXPECT_EQ(numBytes(page["mesh"]), 36 * num_triangles);
  EXPECT_EQ(numBytes(page["panels"][0]["mesh_colors"]), 9 * num_triangles);
  EXPECT_EQ(page["panels"][0]["show_points"], false);
  EXPECT_EQ(page["panels"][0]["segments"].size(), 3u) << "a swatch for each";
}

}  // namespace
