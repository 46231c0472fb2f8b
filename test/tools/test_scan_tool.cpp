#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/shape_input.h"
#include "tools/lathe_mesh.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

class ScanTool : public ToolTest {
protected:
  ScanTool() : ToolTest(toolPath("scan")) {}

  const std::string mesh_ = folder_.write("box.off", boxOFF("1"));
};

TEST_F(ScanTool, WritesOneOrganizedScanWithItsViewpoint) {
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "a.pcd") + " -direction -1,-2,0.5 -json " + (folder_ / "a.json")), 0)
      << error_;
  const nlohmann::json report = nlohmann::json::parse(contentOf(folder_ / "a.json"));
  ASSERT_EQ(report["scans"].size(), 1u);
  const nlohmann::json& scan = report["scans"][0];
  const Shape shape = loadShape(scan["file"].get<std::string>());
  EXPECT_EQ(shape.points->width, scan["width"].get<unsigned>());
  EXPECT_EQ(shape.points->height, scan["height"].get<unsigned>());
  EXPECT_GT(shape.points->height, 1u);
  int num_points = 0;
  for (const pcl::PointXYZ& point : *shape.points) {
    if (!std::isfinite(point.x)) continue;
    ++num_points;
    const Eigen::Array3f share = point.getVector3fMap().array().abs() / Eigen::Array3f(1, 1, 2);
    EXPECT_NEAR(share.maxCoeff(), 1, 1e-5) << "on the surface of the box";
  }
  EXPECT_EQ(num_points, scan["num_points"].get<int>());
  EXPECT_NEAR(num_points, 10000, 500);
  const Eigen::Vector3d expected = 2 * std::sqrt(24.0) * Eigen::Vector3d(-1, -2, 0.5).normalized();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(scan["viewpoint"][k].get<double>(), expected[k], 1e-9);
    EXPECT_NEAR(shape.sensor_origin[k], expected[k], 1e-4);
  }
  EXPECT_EQ(scan["transform"].get<std::vector<double>>(),
            (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
  for (const char* step : {"load", "scan", "save"}) EXPECT_GE(report["timing_ms"][step].get<double>(), 0);
  EXPECT_NE(error_.find("[done, "), std::string::npos);
}

TEST_F(ScanTool, WritesEightScansInOneRandomPose) {
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "b.pcd") + " -all -random_pose -seed 3 -quiet -points 2000 -json " +
                (folder_ / "b.json")),
            0);
  EXPECT_EQ(output_ + error_, "");
  const nlohmann::json report = nlohmann::json::parse(contentOf(folder_ / "b.json"));
  ASSERT_EQ(report["scans"].size(), 8u);
  for (int i = 0; i < 8; ++i) {
    const nlohmann::json& scan = report["scans"][i];
    EXPECT_EQ(scan["file"], folder_ / ("b_" + std::to_string(i) + ".pcd"));
    EXPECT_EQ(scan["transform"], report["scans"][0]["transform"]);
    Eigen::Matrix4d transform;
    for (int k = 0; k < 16; ++k) transform(k / 4, k % 4) = scan["transform"][k].get<double>();
    const Eigen::Matrix4d to_model = transform.inverse();
    const Shape shape = loadShape(scan["file"].get<std::string>());
    for (const pcl::PointXYZ& point : *shape.points) {
      if (!std::isfinite(point.x)) continue;
      const Eigen::Vector3d p = (to_model * point.getVector3fMap().cast<double>().homogeneous()).head<3>();
      EXPECT_NEAR((p.array().abs() / Eigen::Array3d(1, 1, 2)).maxCoeff(), 1, 1e-5);
    }
  }
}

}  // namespace
