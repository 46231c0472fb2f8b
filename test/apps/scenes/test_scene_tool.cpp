#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <nlohmann/json.hpp>

#include "apps/support/tool_run.h"
#include "common/shape_input/shape_input.h"
#include "shapes/table.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class SceneTool : public ToolTest {
protected:
  SceneTool() : ToolTest(toolPath("scene")) {
    const test::Scan& scan = table_.scan;
    pcl::PointCloud<pcl::PointXYZ> cloud(scan.width, scan.height);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      cloud[i].getVector3fMap() = scan.pixels.col(static_cast<Eigen::Index>(i));
    cloud.is_dense = false;
    pcl::io::savePCDFileBinary(scene_, cloud);
  }

  const test::Table table_{{{-0.35, 0.1, 0.0}, {0.25, 0.0, 0.0}}};
  const std::string scene_ = folder_ / "scene.pcd";
};

TEST_F(SceneTool, WritesWhatItFinds) {
  const std::string json = folder_ / "objects.json", completed = folder_ / "completed.pcd",
                    png = folder_ / "objects.png";
  ASSERT_EQ(run(scene_ + " " + completed + " -max_points 1000 -json " + json + " -png " + png), 0) << error_;
  EXPECT_EQ(output_.substr(0, output_.find('\n')), "1 supporting plane, 2 objects");
  const nlohmann::json report = nlohmann::json::parse(contentOf(json));
  ASSERT_EQ(report["objects"].size(), 2u);
  EXPECT_EQ(report["viewpoint"]["from"], "rays");
  ASSERT_EQ(report["supports"].size(), 1u);
  EXPECT_NEAR(report["supports"][0]["coefficients"][2].get<double>(), 1.0, 0.01);
  std::size_t num_added = 0;
  for (const nlohmann::json& object : report["objects"]) {
    EXPECT_EQ(object["frame"]["transform"].size(), 16u);
    EXPECT_GT(object["num_points"], 300);
    if (object.contains("completed")) num_added += object["completed"]["num_added"].get<std::size_t>();
  }
  const Shape written = loadShape(completed);
  EXPECT_EQ(written.points->size(), static_cast<std::size_t>(table_.scan.cloud().cols()) + num_added);
  for (const char* name : {"object", "completed"})
    EXPECT_TRUE(std::any_of(written.cloud.fields.begin(), written.cloud.fields.end(),
                            [&](const pcl::PCLPointField& field) { return field.name == name; }))
        << name;
  EXPECT_EQ(contentOf(png).substr(1, 3), "PNG");
}

TEST_F(SceneTool, RefusesWhatIsNoScene) {
  const std::string mesh = folder_.write("t.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(run(mesh), 1);
  EXPECT_NE(error_.find(mesh + ": is a mesh, must be a cloud as a sensor sees it"), std::string::npos) << error_;
  EXPECT_EQ(run(scene_ + " -database " + (folder_ / "none.db")), 1);
  EXPECT_NE(error_.find("none.db"), std::string::npos) << error_;
  EXPECT_EQ(run(scene_ + " -min_points 3"), 2);
  EXPECT_EQ(run(scene_ + " out.txt"), 2);
}

}  // namespace
