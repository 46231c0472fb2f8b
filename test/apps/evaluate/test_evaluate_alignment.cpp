#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"
#include "common/shape_input/shape_input.h"
#include "evaluate/frames/frame_difference.h"
#include "evaluate/segmentation/patches.h"
#include "evaluate/shared/class_file.h"

namespace {

using namespace pcl_symmetry::apps;
using nlohmann::json;

Eigen::Matrix3d turned(double degrees, const Eigen::Vector3d& about) {
  return Eigen::AngleAxisd(degrees * M_PI / 180.0, about.normalized()).toRotationMatrix();
}

TEST(FrameDifference, IsBlindToOrderAndSigns) {
  const Eigen::Matrix3d a = turned(50.0, {1.0, 2.0, -1.0}), b = turned(7.0, {0.3, -1.0, 2.0}) * a;
  EXPECT_NEAR(angleOfAxes(a, b), 7.0, 1e-6);
  Eigen::Matrix3d shuffled;
  shuffled << -b.col(2), b.col(0), -b.col(1);
  EXPECT_NEAR(angleOfAxes(a, shuffled), 7.0, 1e-6);
  EXPECT_GT(angleToNearest(a, {shuffled}), 60.0);
  EXPECT_NEAR(angleToNearest(a, {shuffled, b}), 7.0, 1e-6);
}

TEST(FrameDifference, AllowsAnyAngleAboutAnAxisOfRevolution) {
  const Eigen::Matrix3d a = turned(20.0, {1.0, 1.0, 0.0});
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d b = a * turned(37.0, Eigen::Vector3d::Unit(axis));
    EXPECT_NEAR(angleOfAxes(a, b), 37.0, 1e-6);
    EXPECT_NEAR(angleOfAxes(a, b, axis), 0.0, 1e-5);
    EXPECT_NEAR(angleToNearest(a, {b}, axis), 0.0, 1e-5);
    const Eigen::Matrix3d tilted = turned(4.0, a.col((axis + 1) % 3)) * b;
    EXPECT_NEAR(angleOfAxes(a, tilted, axis), 4.0, 1e-5);
    EXPECT_EQ(angleOfAxes(a, tilted, 3), 0.0);
  }
}

TEST(Patches, TakeTheirShareOfTheFinitePoints) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 2000; ++i)
    cloud.push_back({static_cast<float>(i % 50), static_cast<float>(i / 50), i % 4 ? 0.0f : NAN});
  const auto num_finite = [&] {
    return std::count_if(cloud.begin(), cloud.end(), [](const auto& p) { return std::isfinite(p.z); });
  };
  ASSERT_EQ(num_finite(), 1500);
  removePatches(cloud, 0.2, 10, 3);
  EXPECT_EQ(num_finite(), 1200);
  removePatches(cloud, 0.0, 10, 3);
  EXPECT_EQ(num_finite(), 1200);
}

/// The tool on a folder with a box, a vase and a tetrahedron.
class EvaluateAlignment : public ToolTest {
protected:
  EvaluateAlignment() : ToolTest(toolPath("evaluate")) {
    boost::filesystem::create_directories(folder_ / "meshes");
    folder_.write("meshes/box.off", boxOFF());
    folder_.write("meshes/m7.off", vaseOFF());
    folder_.write("meshes/tetrahedron.off", tetrahedronOFF());
  }

  int evaluate(const std::string& arguments) {
    return run("alignment " + (folder_ / "meshes") + " -points 3000 -json " + json_ + " " + arguments);
  }
  json method(std::size_t index) const { return json::parse(contentOf(json_))["methods"][index]; }

  const std::string json_ = folder_ / "summary.json";
};

TEST_F(EvaluateAlignment, ComparesFramesOfScansWithThoseOfWholes) {
  const std::string csv = folder_ / "c.csv", histograms = folder_ / "h.csv";
  ASSERT_EQ(evaluate("-num_views 2 -csv " + csv + " -histogram_csv " + histograms + " -png " + (folder_ / "a.png")), 0)
      << error_;
  const json symmetry = method(0), mass = method(2);
  EXPECT_EQ(symmetry["method"], "symmetry");
  EXPECT_EQ(symmetry["num_models"], 3);
  EXPECT_EQ(symmetry["num_scans"], 6);
  EXPECT_EQ(mass["ratio_to_mass"]["mean"], 1.0);
  EXPECT_EQ(mass["closer_rate"]["scans"], 0.0);
  EXPECT_LT(symmetry["center"]["mean"].get<double>(), mass["center"]["mean"].get<double>());
  EXPECT_GE(symmetry["own_axes_turned_rate"]["wholes"].get<double>(), 0.6) << "a box and a vase";
  EXPECT_NE(output_.find("as published"), std::string::npos);

  std::istringstream rows(contentOf(csv));
  std::string line;
  std::getline(rows, line);
  const auto num_commas = std::count(line.begin(), line.end(), ',');
  int num_rows = 0;
  for (; std::getline(rows, line); ++num_rows) EXPECT_EQ(std::count(line.begin(), line.end(), ','), num_commas);
  EXPECT_EQ(num_rows, 3 * 3 * 4) << "three clouds of three models, four methods";

  std::istringstream shares(contentOf(histograms));
  std::getline(shares, line);
  EXPECT_EQ(line, "misalignment,method,from,share");
  double total = 0.0;
  while (std::getline(shares, line))
    if (line.rfind("rotation_deg,symmetry,", 0) == 0) total += std::stod(line.substr(line.rfind(',') + 1));
  EXPECT_NEAR(total, 1.0, 1e-4);
  for (const char* name : {"a_translation.png", "a_rotation.png"})
    EXPECT_EQ(contentOf(folder_ / name).substr(1, 3), "PNG");
}

TEST_F(EvaluateAlignment, RestrictsToAClassification) {
  const std::string classes = folder_ / "some.cla";
  folder_.write("some.cla", "PSB 1\n2 1\n\nvessel 0 0\n\nvase vessel 1\n7\n");
  EXPECT_EQ(modelsOfClassFile(classes), std::set<std::string>{"m7"});
  ASSERT_EQ(evaluate("-num_views 1 -noise 0.01 -missing 0.2 -cla " + classes), 0) << error_;
  EXPECT_EQ(method(0)["num_models"], 1);

  folder_.write("some.cla", "PSB 1\n2 5\n\nvessel 0 0\n\nvase vessel 1\n7\n");
  EXPECT_EQ(evaluate("-cla " + classes), 1);
  EXPECT_NE(error_.find("names 1 models, must be 5"), std::string::npos) << error_;
}

TEST_F(EvaluateAlignment, RefusesWrongUsage) {
  EXPECT_EQ(evaluate("-missing 1"), 2);
  EXPECT_EQ(evaluate("-num_views 9"), 2);
  EXPECT_EQ(run("alignment " + (folder_ / "nothing")), 1);
}

}  // namespace
