#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/tool_run.h"
#include "io/shape_input.h"

namespace {

using namespace pcl_symmetry::apps;

class ScanTool : public ToolTest {
protected:
  ScanTool() : ToolTest(toolPath("scan")) {}

  const std::string mesh_ =
      folder_.write("box.off",
                    "OFF\n8 6 12\n-1 -1 -2\n1 -1 -2\n1 1 -2\n-1 1 -2\n-1 -1 2\n1 -1 2\n1 1 2\n-1 1 2\n"
                    "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n");
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

TEST_F(ScanTool, SameBytesForAnyNumberOfThreads) {
  const std::string arguments = " -noise 0.01 -random_pose -seed 9 -quiet -threads ";
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "1.pcd") + arguments + "1"), 0);
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "2.pcd") + arguments + "2"), 0);
  EXPECT_EQ(contentOf(folder_ / "1.pcd"), contentOf(folder_ / "2.pcd"));
}

TEST_F(ScanTool, TakesTheFieldOfViewInDegrees) {
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "a.pcd") + " -points 500 -fov 3"), 0) << error_;
  EXPECT_NE(error_.find("a larger -fov or -distance shows all of it"), std::string::npos)
      << "3 degrees see 0.1 of two diagonals away: " << error_;
  ASSERT_EQ(run(mesh_ + " " + (folder_ / "a.pcd") + " -points 500 -fov 40"), 0) << error_;
  EXPECT_EQ(error_.find("larger -fov"), std::string::npos) << error_;
  EXPECT_EQ(run(mesh_ + " " + (folder_ / "a.pcd") + " -fov 180"), 2);
}

TEST_F(ScanTool, KeepsCoordinatesBeyondFloatPrecision) {
  const std::string far = folder_.write("far.off",
                                        "OFF\n4 4 0\n500000 5000000 100\n500001 5000000 100\n500000 5000001 100\n"
                                        "500000 5000000 101\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  ASSERT_EQ(run(far + " " + (folder_ / "a.pcd") + " -points 500 -json " + (folder_ / "a.json")), 0) << error_;
  const Shape scan = loadShape(folder_ / "a.pcd");
  int num_points = 0;
  for (const pcl::PointXYZ& point : *scan.points) {
    if (!std::isfinite(point.x)) continue;
    ++num_points;
    const Eigen::Vector3d x =
        point.getVector3fMap().cast<double>() + scan.shift - Eigen::Vector3d(500000, 5000000, 100);
    EXPECT_NEAR(x.sum(), 1.0, 1e-5) << "on the face that looks to the scanner";
  }
  EXPECT_GT(num_points, 400);
  const auto viewpoint = nlohmann::json::parse(contentOf(folder_ / "a.json"))["scans"][0]["viewpoint"];
  EXPECT_NEAR(viewpoint[0].get<double>(), 500000.5 + 2.0, 1e-6) << "two diagonals of sqrt(3) along (1, 1, 1)";
}

TEST_F(ScanTool, ExitsWithTwoForWrongUsage) {
  const std::string files = mesh_ + " " + (folder_ / "a.pcd");
  for (const std::string& arguments :
       {std::string(), mesh_, files + " -bogus", files + " -corner 8", files + " -corner 1 -all", files + " -noise -1",
        files + " -direction 0,0,0", files + " -points 0", files + " -threads -1", mesh_ + " a.xyz",
        files + " -grid 64"}) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
    EXPECT_NE(error_.find("(see pcl_symmetry_scan -h)"), std::string::npos) << error_;
  }
  EXPECT_FALSE(boost::filesystem::exists(folder_ / "a.pcd"));
}

TEST_F(ScanTool, ExitsWithOneForBadFiles) {
  folder_.write("empty.pcd", "");
  folder_.write("cloud.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                "end_header\n1 2 3\n");
  folder_.write("flat.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
  for (const std::string input : {"missing.off", "empty.pcd", "cloud.ply", "flat.off"}) {
    EXPECT_EQ(run((folder_ / input) + " " + (folder_ / "a.pcd") + " -quiet"), 1) << input;
    EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  }
  EXPECT_EQ(run(mesh_ + " " + (folder_ / "missing/a.pcd") + " -quiet"), 1);
  EXPECT_NE(error_.find("there is no directory"), std::string::npos) << error_;
}

TEST_F(ScanTool, HelpShowsAnExample) {
  ASSERT_EQ(run("-h"), 0);
  EXPECT_NE(output_.find("Example:\n  pcl_symmetry_scan "), std::string::npos);
}

}  // namespace
