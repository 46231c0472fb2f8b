#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"
#include "common/shape_input/shape_input.h"
#include "core/base/random.h"
#include "evaluate/frames/frame_difference.h"
#include "evaluate/frames/mesh_ties.h"
#include "evaluate/frames/published_frame.h"
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

/// A symmetry of reflections in the three planes of a box turns frames whose axes lie askew, as the method of one box.
TEST(MeshTies, AreTheSymmetriesOfTheMesh) {
  ReferenceSymmetries box;
  for (int k = 0; k < 3; ++k) box.planes.push_back({pcl_symmetry::ReflectionPlane(Eigen::Vector3d::Unit(k), 0.0), 1.0});
  const MeshTies ties = tiesOf(box);
  EXPECT_EQ(ties.turns.size(), 4u) << "the identity and three half-turns";
  const Eigen::Matrix3d askew = turned(25.0, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(angleOfAxes(askew.transpose(), askew), 40.0, 1e-6) << "50 degrees are as good as 40";
  EXPECT_NEAR(angleUpToTies(askew.transpose(), askew, ties), 0.0, 1e-5) << "each is the other's reflection";
  EXPECT_NEAR(angleUpToTies(askew, askew, tiesOf({})), 0.0, 1e-5);
  EXPECT_NEAR(angleUpToTies(askew.transpose(), askew, tiesOf({})), 40.0, 1e-5);
}

TEST(MeshTies, OfABodyOfRevolutionTurnAboutItsAxis) {
  ReferenceSymmetries vase;
  vase.axes.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), 1.0});
  const Eigen::Matrix3d a = turned(30.0, {1.0, 2.0, 0.5}), b = turned(77.0, Eigen::Vector3d::UnitX()) * a;
  EXPECT_NEAR(angleUpToTies(b, a, tiesOf(vase)), 0.0, 1e-5);
  // Tilted by 4 degrees away from the axis: no turn about it takes that back.
  const Eigen::Matrix3d straight = Eigen::Matrix3d::Identity(), tilted = turned(4.0, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(angleUpToTies(tilted, straight, tiesOf(vase)), 4.0, 1e-5);
  vase.centers.push_back({Eigen::Vector3d::Zero(), 1.0});
  EXPECT_EQ(angleUpToTies(tilted, straight, tiesOf(vase)), 0.0);
}

/// A box whose sides differ: every plane is found by either form of the method.
TEST(PublishedFrame, FindsTheAxesOfABox) {
  pcl_symmetry::Points points(3, 4000);
  pcl_symmetry::RandomStream random(4);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto side = static_cast<Eigen::Index>(random.below(3));
    for (Eigen::Index k = 0; k < 3; ++k) points(k, i) = static_cast<float>(2.0 * random.uniform() - 1.0);
    points(side, i) = points(side, i) < 0.0f ? -1.0f : 1.0f;
    points(0, i) *= 2.0f;
    points(1, i) *= 1.4f;
  }
  const Eigen::Matrix3d turn = turned(33.0, {1.0, -0.4, 0.7});
  const Eigen::Vector3d center(4.0, -2.0, 1.0);
  points = ((turn.cast<float>() * points).colwise() + center.cast<float>()).eval();
  PublishedFrameOptions options;
  const PublishedFrame refined = publishedFrame(points, options);
  EXPECT_LT(angleOfAxes(refined.axes, turn), 0.5);
  EXPECT_LT((refined.center - center).norm(), 0.02);
  EXPECT_NEAR(refined.axes.determinant(), 1.0, 1e-9);
  options.refined = false;
  const PublishedFrame coarse = publishedFrame(points, options);
  EXPECT_LT(angleOfAxes(coarse.axes, turn), 6.0) << "bins are up to 5.6 degrees apart";
  EXPECT_LT(angleOfAxes(refined.axes, turn), angleOfAxes(coarse.axes, turn));
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
  const json symmetry = method(0), mass = method(5);
  EXPECT_EQ(symmetry["method"], "symmetry");
  EXPECT_EQ(symmetry["num_models"], 3);
  EXPECT_EQ(symmetry["num_scans"], 6);
  EXPECT_EQ(mass["ratio_to_mass"]["mean"], 1.0);
  EXPECT_EQ(mass["closer_rate"]["scans"], 0.0);
  EXPECT_LT(symmetry["center"]["mean"].get<double>(), mass["center"]["mean"].get<double>());
  EXPECT_GE(symmetry["own_axes_turned_rate"]["wholes"].get<double>(), 0.6) << "a box and a vase";
  for (const char* name : {"no free space", "first maximum", "exact map", "exact map ISP", "90 %"})
    EXPECT_NE(output_.find(name), std::string::npos) << name;

  std::istringstream rows(contentOf(csv));
  std::string line;
  std::getline(rows, line);
  const auto num_commas = std::count(line.begin(), line.end(), ',');
  int num_rows = 0;
  for (; std::getline(rows, line); ++num_rows) EXPECT_EQ(std::count(line.begin(), line.end(), ','), num_commas);
  EXPECT_EQ(num_rows, 3 * 3 * 7) << "three clouds of three models, seven methods";

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
  ASSERT_EQ(evaluate("-num_views 1 -noise 0.01 -missing 0.2 -ties -methods 'exact map' -cla " + classes), 0) << error_;
  EXPECT_NE(output_.find("like for like"), std::string::npos);
  EXPECT_TRUE(method(0)["like_for_like_rate"].is_number());
  EXPECT_EQ(method(0)["num_models"], 1);

  folder_.write("some.cla", "PSB 1\n2 5\n\nvessel 0 0\n\nvase vessel 1\n7\n");
  EXPECT_EQ(evaluate("-cla " + classes), 1);
  EXPECT_NE(error_.find("names 1 models, must be 5"), std::string::npos) << error_;
}

TEST_F(EvaluateAlignment, RefusesWrongUsage) {
  EXPECT_EQ(evaluate("-missing 1"), 2);
  EXPECT_EQ(evaluate("-num_views 9"), 2);
  EXPECT_EQ(evaluate("-methods guess"), 2);
  EXPECT_NE(error_.find("must be one of symmetry, no free space"), std::string::npos) << error_;
  EXPECT_EQ(run("alignment " + (folder_ / "nothing")), 1);
}

}  // namespace
