#include <gtest/gtest.h>

#include <sstream>

#include "apps/support/tool_run.h"
#include "common/pictures/raster_image.h"
#include "common/shape_input/shape_input.h"
#include "pcl_symmetry/symmetry_detection.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class MakeShapes : public ToolTest {
protected:
  MakeShapes() : ToolTest(MAKE_SHAPES) {}
};

TEST_F(MakeShapes, VehiclesHaveThePlaneBetweenTheirSides) {
  ASSERT_EQ(run(folder_ / "shapes"), 0) << error_;
  for (const std::string name : {"car", "airplane", "teapot"}) {
    const Shape shape = loadShape(folder_ / ("shapes/" + name + ".ply"));
    ASSERT_TRUE(shape.mesh) << name;
    const std::vector<SymmetryPlane> planes = detectSymmetryPlanes(*shape.mesh);
    ASSERT_FALSE(planes.empty()) << name;
    EXPECT_LT(planes[0].angleTo(ReflectionPlane(Eigen::Vector3d::UnitY(), 0.0)), 0.01) << name;
    EXPECT_LT(std::abs(planes[0].offset()), 0.01) << name;
  }
  for (const std::string name : {"octopus", "mug", "chair", "carton"})
    EXPECT_TRUE(loadShape(folder_ / ("shapes/" + name + ".ply")).mesh) << name;
  EXPECT_EQ(run(""), 2);
  EXPECT_NE(error_.find("usage"), std::string::npos);
}

class DrawMedialAxis : public ToolTest {
protected:
  DrawMedialAxis() : ToolTest(DRAW_MEDIAL_AXIS) {}
};

/// The border of a rectangle of 2 x 1 as points at steps of 0.01.
std::string rectangle() {
  std::ostringstream points;
  int num = 0;
  for (int i = -100; i <= 100; ++i, num += 2) points << 0.01 * i << " 0.5 0\n" << 0.01 * i << " -0.5 0\n";
  for (int i = -49; i <= 49; ++i, num += 2) points << "1 " << 0.01 * i << " 0\n-1 " << 0.01 * i << " 0\n";
  std::ostringstream pcd;
  pcd << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << num
      << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << num << "\nDATA ascii\n"
      << points.str();
  return pcd.str();
}

TEST_F(DrawMedialAxis, OfARectangleIsARidgeWithABranchToEachCorner) {
  constexpr int kSize = 224;  // 100 pixels a unit: 1.12 times the rectangle
  const std::string picture = folder_ / "axis.png";
  ASSERT_EQ(run(picture + " 224 " + folder_.write("rectangle.pcd", rectangle())), 0) << error_;
  const RasterImage image = readImage(picture);
  ASSERT_EQ(image.width, kSize);
  const auto isDark = [&](double x, double y) {  // within two pixels
    const int column = static_cast<int>(kSize / 2 + 100 * x), row = static_cast<int>(kSize / 2 - 100 * y);
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (image.at(column + dx, row + dy)[0] < 128) return true;
    return false;
  };
  EXPECT_TRUE(isDark(0.0, 0.0));
  EXPECT_TRUE(isDark(0.4, 0.0));
  for (const double x : {-0.75, 0.75})
    for (const double y : {-0.25, 0.25}) EXPECT_TRUE(isDark(x, y)) << "half-way to a corner";
  EXPECT_FALSE(isDark(0.0, 0.25));
  EXPECT_FALSE(isDark(0.85, 0.0));
}

}  // namespace
