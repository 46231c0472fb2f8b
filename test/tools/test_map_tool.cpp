#include <gtest/gtest.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/shape_input.h"
#include "pictures/raster_image.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

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

}  // namespace
