/// The tool of lines in a plane and the pictures it reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pictures/raster_image.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class LinesTool : public ToolTest {
protected:
  LinesTool() : ToolTest(toolPath("lines")) {}
};

/// A dark isosceles triangle about x = 30, on light ground.
RasterImage triangle() {
  RasterImage image(64, 48);
  for (int y = 6; y < 42; ++y)
    for (int x = 0; x < 64; ++x)
      if (std::abs(x - 30) <= (y - 6) / 2) image.set(x, y, Eigen::Vector3d::Zero());
  return image;
}

TEST_F(LinesTool, FindsTheLineOfAPicture) {
  writeImage(triangle(), folder_ / "triangle.png");
  for (const std::string flag : {"", " -filled"}) {
    const nlohmann::json shape = reportOf((folder_ / "triangle.png") + flag + " -quiet")["shapes"][0];
    const nlohmann::json& line = shape["lines"][0];
    const double sign = line["coefficients"][0].get<double>() < 0.0 ? -1.0 : 1.0;
    EXPECT_NEAR(sign * line["coefficients"][0].get<double>(), 1.0, 1e-3);
    EXPECT_NEAR(sign * line["coefficients"][2].get<double>(), -30.0, 0.1);
    EXPECT_GT(line["score"].get<double>(), 0.95);
    EXPECT_NE(output_.find("triangle.png"), std::string::npos);
  }
}

TEST_F(LinesTool, ReadsPGMAndDrawsWithoutADisplay) {
  std::string pgm_text = "P5\n15 15\n255\n";
  for (int i = 0; i < 225; ++i) {
    const int x = std::abs(i % 15 - 7), y = std::abs(i / 15 - 7);
    pgm_text += x * y == 0 && x + y < 7 ? '\xFF' : '\0';
  }
  const std::string pgm = folder_.write("plus.pgm", pgm_text);
  writeImage(triangle(), folder_ / "triangle.png");
  ASSERT_EQ(run(pgm + " " + (folder_ / "triangle.png") + " -quiet -columns 1 -size 40 -png " + (folder_ / "a.png")), 0)
      << error_;
  const RasterImage picture = readImage(folder_ / "a.png");
  EXPECT_EQ(picture.width, 40);
  EXPECT_EQ(picture.height, 84);
  // The middle of a plus lies on four lines, its surroundings on none.
  EXPECT_LT(picture.at(20, 18)[0], 60);
}

TEST_F(LinesTool, RefusesWhatItCannotUse) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run(folder_ / "missing.png"), 1);
  EXPECT_TRUE(fails(folder_.write("broken.png", "no picture"), 1, "must be a PNG or binary PGM"));
  EXPECT_EQ(run(folder_.write("cut.pgm", "P5\n7 7\n255\nabc")), 1);
  writeImage(RasterImage(8, 8), folder_ / "empty.png");
  EXPECT_TRUE(fails(folder_ / "empty.png", 1, "shows nothing"));
  EXPECT_TRUE(fails(folder_.write("box.off", boxOFF()), 1, "8 distinct points, at least 20 are needed"));
  std::string lattice;
  for (int i = 0; i < 27; ++i)
    lattice += std::to_string(i % 3) + ' ' + std::to_string(i / 3 % 3) + ' ' + std::to_string(i / 9) + '\n';
  EXPECT_TRUE(fails(folder_.write("lattice.xyz", lattice), 1, "off a plane"));
}

TEST(RasterImage, WrittenAndReadIsTheSame) {
  const TemporaryFolder folder;
  RasterImage image(5, 3);
  image.set(1, 2, {0.2, 0.6, 1.0});
  image.drawDisk({4.0, 0.0}, 1.0, {0.0, 0.0, 0.0});
  writeImage(image, folder / "a.png");
  EXPECT_EQ(readImage(folder / "a.png").pixels, image.pixels);
  EXPECT_EQ(image.at(1, 2)[1], 153);
  EXPECT_EQ(image.at(3, 0)[0], 0);
}

TEST(ContourOfImage, IsTheOutlineOrAllWithYUpwards) {
  const auto outline = contourOfImage(triangle(), false, "triangle"),
             all = contourOfImage(triangle(), true, "triangle");
  EXPECT_LT(outline->size(), all->size() / 2);
  float highest = 0.0f;
  for (const pcl::PointXYZ& point : *all) highest = std::max(highest, point.y);
  EXPECT_EQ(highest, 41.0f) << "the tip in row 6 of 48";
}

}  // namespace
