/// The tools of the map, of lines in a plane, of views and of parts.
#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/mesh_output.h"
#include "io/shape_input.h"
#include "pictures/raster_image.h"
#include "shapes/meshes.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class MapTool : public ToolTest {
protected:
  MapTool() : ToolTest(toolPath("map")) {}

  const std::string mesh_ = folder_.write("box.off", boxOFF(1.4));
};

TEST_F(MapTool, PointsOnThePlanesOfABoxAreTheMostSymmetric) {
  EXPECT_EQ(reportOf(mesh_ + " " + (folder_ / "box.pcd") + " -quiet")["num_points"], 10000);
  pcl::PointCloud<pcl::PointXYZI> points;
  pcl::fromPCLPointCloud2(loadShape(folder_ / "box.pcd").cloud, points);
  ASSERT_EQ(points.size(), 10000u);
  double near = 0.0, far = 0.0;
  int num_near = 0, num_far = 0;
  for (const pcl::PointXYZI& point : points) {
    const float distance = point.getVector3fMap().cwiseAbs().minCoeff();
    if (distance < 0.05f) {
      near += point.intensity;
      ++num_near;
    } else if (distance > 0.5f) {
      far += point.intensity;
      ++num_far;
    }
  }
  EXPECT_GT(near / num_near, 0.85);
  EXPECT_LT(far / num_far, 0.75);
}

TEST_F(MapTool, ShowsOnATerminalHowFarItIs) {
  const std::string command = toolPath("map") + " " + mesh_ + " -points 150000 -grid 16";
  if (std::system(("script -qec '" + command + "' " + (folder_ / "terminal") + " >/dev/null").c_str()) == 127)
    GTEST_SKIP() << "needs the program script";
  EXPECT_NE(contentOf(folder_ / "terminal").find("\rMapping back to points ["), std::string::npos);
  EXPECT_NE(contentOf(folder_ / "terminal").find(" 66 %"), std::string::npos);
}

TEST_F(MapTool, WritesAVTKImageAndSlices) {
  ASSERT_EQ(
      run(mesh_ + " -quiet -cells 20 -size 50 -volume " + (folder_ / "a.vti") + " -slices " + (folder_ / "a.png")), 0)
      << error_;
  const std::string vti = contentOf(folder_ / "a.vti");
  EXPECT_NE(vti.find("WholeExtent=\"0 11 0 14 0 19\""), std::string::npos) << vti.substr(0, 400);
  EXPECT_NE(vti.find("Name=\"symmetry\""), std::string::npos);
  const RasterImage slices = readImage(folder_ / "a.png");
  EXPECT_EQ(slices.width, 158);
  EXPECT_EQ(slices.height, 50);
}

TEST_F(MapTool, ABoxHasThreeAxesOfHalfTurnsAndACenter) {
  const std::string common = mesh_ + " -quiet -grid 32 -points 3000";
  const auto axes = reportOf(common + " -of axes -fold 2 -png " + (folder_ / "a.png"))["axes"];
  EXPECT_NE(output_.find("symmetry of the axes through the points"), std::string::npos);
  ASSERT_GE(axes.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(axes[k]["fold"], 2);
    double greatest = 0.0;
    for (const double c : axes[k]["direction"]) greatest = std::max(greatest, std::abs(c));
    // 2 cells of 16 in the cube are wide; measured: 1 to 2 degrees
    EXPECT_GT(greatest, 0.995);
    EXPECT_GT(axes[k]["symmetry"], 0.9);
  }
  const auto center = reportOf(common + " -of centers")["centers"][0]["point"];
  for (const double c : center) EXPECT_NEAR(c, 0.0, 0.2);
}

TEST_F(MapTool, RefusesFoldsThatHaveNoMeaning) {
  EXPECT_TRUE(fails(mesh_ + " -fold 3", 2, "-fold goes with -of axes"));
  EXPECT_TRUE(fails(mesh_ + " -of axes -fold 1", 2, "a turn of order 1 changes nothing"));
  EXPECT_EQ(run(mesh_ + " -of lines"), 2);
}

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

class ViewpointTool : public ToolTest {
protected:
  ViewpointTool() : ToolTest(toolPath("viewpoint")) {}

  const std::string mesh_ = folder_.write("box.off", boxOFF(1.4));
};

TEST_F(ViewpointTool, LooksAtABoxFromACornerAndWorstAlongItsPlanes) {
  const nlohmann::json answer = reportOf(mesh_ + " -quiet");
  const auto best = answer["best"]["direction"].get<std::vector<double>>();
  const auto worst = answer["worst"]["direction"].get<std::vector<double>>();
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(std::abs(best[k]), 0.3);
    largest = std::max(largest, std::abs(worst[k]));
  }
  EXPECT_GT(largest, 0.99);
  EXPECT_GT(answer["best"]["score"].get<double>(), answer["worst"]["score"].get<double>());
  EXPECT_EQ(answer["best"]["pose"].size(), 16u);
  EXPECT_EQ(answer["good"][0], answer["best"]);
  EXPECT_NE(output_.find("worst"), std::string::npos);
  EXPECT_GT(reportOf(mesh_ + " -quiet -as_published")["best"]["score"], answer["best"]["score"]) << "all maxima";
}

TEST_F(ViewpointTool, DrawsTheScoreAndTheViews) {
  ASSERT_EQ(run(mesh_ + " -size 120 -png " + (folder_ / "a.png") + " -icon " + (folder_ / "b.png")), 0) << error_;
  EXPECT_EQ(readImage(folder_ / "a.png").width, 360);
  EXPECT_EQ(readImage(folder_ / "b.png").width, 120);
}

using nlohmann::json;

class SegmentTool : public ToolTest {
protected:
  SegmentTool() : ToolTest(toolPath("segment")) {
    folder_.write("dumbbell.off", offText(dumbbell_.vertices.cast<double>(), dumbbell_.polygons));
  }

  const test::Mesh dumbbell_ = test::dumbbell();
  const std::string mesh_ = folder_ / "dumbbell.off", seg_ = folder_ / "out.seg", json_ = folder_ / "tree.json";
};

TEST_F(SegmentTool, WritesASegmentForEachFaceATreeAndAPicture) {
  ASSERT_EQ(run(mesh_ + " " + seg_ + " -parts 3 -json " + json_ + " -size 300 -png " + (folder_ / "p.png") + " -html " +
                (folder_ / "p.html")),
            0)
      << error_;
  EXPECT_NE(contentOf(folder_ / "p.html").find("\"part 3: "), std::string::npos) << "parts one by one";
  const std::vector<int> labels = readFaceLabels(seg_);
  ASSERT_EQ(labels.size(), dumbbell_.polygons.size());
  EXPECT_EQ(std::set<int>(labels.begin(), labels.end()), (std::set<int>{0, 1, 2}));
  const json tree = json::parse(contentOf(json_));
  EXPECT_EQ(tree["elements"], "faces");
  ASSERT_EQ(tree["segments"].size(), 3u);
  EXPECT_EQ(tree["segments"][0]["size"], std::count(labels.begin(), labels.end(), 0));
  ASSERT_EQ(tree["tree"].size(), 5u) << "three leaves of a binary tree";
  EXPECT_EQ(tree["tree"][0]["parent"], -1);
  EXPECT_FALSE(tree["tree"][0]["planes"].empty());
  EXPECT_NE(error_.find("3 parts"), std::string::npos) << error_;
  const RasterImage picture = readImage(folder_ / "p.png");
  EXPECT_EQ(picture.width, 300);
  EXPECT_EQ(picture.height, 300);
  ASSERT_EQ(run(mesh_ + " -parts 3 -size 300 -up 1,0,0 -png " + (folder_ / "q.png")), 0) << error_;
  EXPECT_NE(readImage(folder_ / "q.png").pixels, picture.pixels);
}

TEST_F(SegmentTool, MethodsOfThePaper) {
  for (const std::string flag : {"", " -as_published"}) {
    ASSERT_EQ(run(mesh_ + " " + seg_ + " -method splitting -depth 1 -quiet" + flag), 0) << error_;
    const std::vector<int> labels = readFaceLabels(seg_);
    EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), 1) << flag;
    EXPECT_EQ(error_, "");
  }
}

TEST_F(SegmentTool, LabelsPointsOfCloudsAndKeepsTheirFields) {
  std::ostringstream pcd;
  pcd << "VERSION .7\nFIELDS x y z weight\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH "
      << dumbbell_.polygons.size() << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << dumbbell_.polygons.size()
      << "\nDATA ascii\n";
  for (std::size_t f = 0; f < dumbbell_.polygons.size(); ++f) pcd << dumbbell_.center(f).transpose() << " 7\n";
  const std::string cloud = folder_.write("cloud.pcd", pcd.str()), out = folder_ / "labeled.pcd";
  ASSERT_EQ(run(cloud + " " + out + " -parts 2 -png " + (folder_ / "p.png")), 0) << error_;
  pcl::PCLPointCloud2 labeled;
  ASSERT_EQ(pcl::io::loadPCDFile(out, labeled), 0);
  ASSERT_EQ(labeled.fields.size(), 5u);
  std::set<std::string> names;
  for (const pcl::PCLPointField& field : labeled.fields) names.insert(field.name);
  EXPECT_EQ(names, (std::set<std::string>{"x", "y", "z", "weight", "label"}));
  EXPECT_EQ(labeled.width, dumbbell_.polygons.size());
  EXPECT_EQ(run(cloud + " " + seg_), 1) << "a cloud has no faces";
}

TEST_F(SegmentTool, ColorsTheFacesOfAMeshInPLY) {
  const std::string out = folder_ / "parts.ply";
  ASSERT_EQ(run(mesh_ + " " + out + " -parts 2"), 0) << error_;
  const std::string ply = contentOf(out);
  EXPECT_NE(ply.find("element face " + std::to_string(dumbbell_.polygons.size())), std::string::npos);
  EXPECT_NE(ply.find("property int label"), std::string::npos);
}

TEST_F(SegmentTool, RefusesWhatDoesNotFitTogether) {
  EXPECT_EQ(run(mesh_ + " out.obj"), 2);
  EXPECT_EQ(run(mesh_ + " -depth 2"), 2) << "needs the paper's method";
  EXPECT_EQ(run(mesh_ + " -method splitting -evidence all"), 2);
  EXPECT_EQ(run(mesh_ + " -parts -1"), 2);
  EXPECT_EQ(run(folder_ / "none.off"), 1);
}

}  // namespace
