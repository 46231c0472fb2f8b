#include <gtest/gtest.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/support/tool_run.h"
#include "core/base/constants.h"
#include "evaluate/registration/motion_error.h"
#include "evaluate/segmentation/patches.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

Eigen::Isometry3d motionOf(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& moved = {0, 0, 0}) {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(degrees * kDegree, axis));
  motion.translation() = moved;
  return motion;
}

/// Of a box about (1, 0, 0).
ReferenceSymmetries boxSymmetries() {
  ReferenceSymmetries symmetries;
  symmetries.center = Eigen::Vector3d::UnitX();
  for (int k = 0; k < 3; ++k)
    symmetries.planes.push_back({ReflectionPlane(Eigen::Vector3d::Unit(k), k == 0 ? 1.0 : 0.0), 1.0});
  return symmetries;
}

TEST(MotionError, IsThatOfTheMotionBesidesTheTruth) {
  const Eigen::Isometry3d truth = motionOf(70.0, Eigen::Vector3d(1, 2, 2) / 3.0, {3, 4, 5});
  const ReferenceSymmetries none;
  const MotionError error = motionError(motionOf(7.0, Eigen::Vector3d::UnitY(), {0.1, 0, 0}) * truth, truth, none);
  EXPECT_NEAR(error.angle, 7.0 * kDegree, 1e-9);
  EXPECT_NEAR(error.distance, 0.1, 1e-9);
  EXPECT_TRUE(error.within(7.1 * kDegree, 0.11));
  EXPECT_FALSE(error.within(6.9 * kDegree, 0.11));
}

TEST(MotionError, HalfTurnsOfABoxAreRight) {
  const Eigen::Vector3d center = Eigen::Vector3d::UnitX();
  for (int k = 0; k < 3; ++k) {
    Eigen::Isometry3d half = motionOf(180.0, Eigen::Vector3d::Unit(k));
    half.translation() = center - half.linear() * center;
    const MotionError error = motionError(half, Eigen::Isometry3d::Identity(), boxSymmetries());
    EXPECT_NEAR(error.angle, 0.0, 1e-6);
    EXPECT_NEAR(error.distance, 0.0, 1e-9);
  }
  EXPECT_NEAR(
      motionError(motionOf(90.0, Eigen::Vector3d::UnitX()), Eigen::Isometry3d::Identity(), boxSymmetries()).angle,
      90.0 * kDegree, 1e-6)
      << "quarter turns are not";
}

TEST(MotionError, AnyAngleAboutAnAxisOfRevolutionIsRight) {
  ReferenceSymmetries symmetries;
  symmetries.axes = {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 1.0}};
  const Eigen::Isometry3d truth = motionOf(33.0, Eigen::Vector3d::UnitX(), {1, 2, 3});
  EXPECT_NEAR(motionError(motionOf(123.0, Eigen::Vector3d::UnitZ()) * truth, truth, symmetries).angle, 0.0, 1e-6);
  const Eigen::Isometry3d over = motionOf(180.0, Eigen::Vector3d::UnitX(), {0, 0, 2});
  EXPECT_NEAR(motionError(over * truth, truth, symmetries).angle, M_PI, 1e-6) << "a cone has a top";
  symmetries.planes = {{ReflectionPlane(Eigen::Vector3d::UnitZ(), 1.0), 1.0}};
  const MotionError error = motionError(over * truth, truth, symmetries);
  EXPECT_NEAR(error.angle, 0.0, 1e-6) << "a cylinder has not";
  EXPECT_NEAR(error.distance, 0.0, 1e-9);
}

TEST(MotionError, AnyRotationOfASphereIsRight) {
  ReferenceSymmetries symmetries;
  symmetries.centers = {{Eigen::Vector3d::Zero(), 1.0}};
  const MotionError error =
      motionError(motionOf(50.0, Eigen::Vector3d::UnitY(), {0, 0.03, 0}), Eigen::Isometry3d::Identity(), symmetries);
  EXPECT_EQ(error.angle, 0.0);
  EXPECT_NEAR(error.distance, 0.03, 1e-9);
}

TEST(MissingPatches, TakeTheShareAway) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 1000; ++i) cloud.push_back({static_cast<float>(i % 40), static_cast<float>(i / 40), 0.0f});
  const auto before = cloud;
  removePatches(cloud, 0.2, 10, 3);
  EXPECT_EQ(cloud.size(), before.size());
  EXPECT_EQ(std::count_if(cloud.begin(), cloud.end(), [](const auto& p) { return std::isfinite(p.x); }), 800);
  auto other = before;
  removePatches(other, 0.0, 10, 3);
  EXPECT_TRUE(std::all_of(other.begin(), other.end(), [](const auto& p) { return std::isfinite(p.x); }));
}

class EvaluateRegistration : public ToolTest {
protected:
  EvaluateRegistration() : ToolTest(toolPath("evaluate") + " registration") {
    folder_.write("box.off",
                  "OFF\n8 6 12\n-1 -1.5 -2\n1 -1.5 -2\n1 1.5 -2\n-1 1.5 -2\n-1 -1.5 2\n1 -1.5 2\n1 1.5 2\n-1 1.5 2\n"
                  "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n");
    folder_.write("pyramid.off",
                  "OFF\n4 4 6\n0 0 0\n2 0.1 0\n0.4 1.3 0.1\n0.7 0.2 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  }
};

TEST_F(EvaluateRegistration, TellsHowOftenEachMethodIsRight) {
  ASSERT_EQ(run((folder_ / ".") + " -points 2000 -num_views 2 -impostors -quiet -csv " + (folder_ / "r.csv") +
                " -json " + (folder_ / "r.json")),
            0)
      << error_;
  const auto report = nlohmann::json::parse(contentOf(folder_ / "r.json"));
  ASSERT_EQ(report["methods"].size(), 3u);
  for (const char* name : {"symmetry", "pca", "features"}) {
    const auto& method = report["methods"][name];
    EXPECT_EQ(method["scans"], 4) << name;
    // A row of the table for each scan; the rate is what the rows say.
    int num_right = 0, num_rows = 0;
    std::istringstream rows(contentOf(folder_ / "r.csv"));
    for (std::string row; std::getline(rows, row);) {
      std::vector<std::string> cells;
      boost::algorithm::split(cells, row, boost::is_any_of(","));
      if (cells.at(3) != name || cells.at(2) != "0") continue;
      ++num_rows;
      num_right += cells.at(4) == "1" ? 1 : 0;
      const bool within = std::stod(cells.at(6)) <= 5.0 && std::stod(cells.at(7)) <= 0.02;
      EXPECT_EQ(cells.at(4) == "1", within) << "right is within the limits: " << row;
    }
    EXPECT_EQ(num_rows, 4) << name;
    EXPECT_DOUBLE_EQ(method["right_rate"].get<double>(), num_right / 4.0) << name;
    EXPECT_GT(method["median_ms"].get<double>(), 0.0);
  }
  EXPECT_EQ(report["methods"]["symmetry"]["right_rate"], 1.0);
  EXPECT_EQ(report["methods"]["symmetry"]["converged_rate"], 1.0);
  EXPECT_EQ(report["methods"]["symmetry"]["impostor_rate"], 0.0) << "a pyramid is no box";
  const std::string csv = contentOf(folder_ / "r.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * (4 + 2));
}

TEST_F(EvaluateRegistration, TracksFromAGuess) {
  ASSERT_EQ(run((folder_ / ".") + " -points 2000 -num_views 2 -methods symmetry,anew -around 15 -quiet -json " +
                (folder_ / "t.json")),
            0)
      << error_;
  const nlohmann::json methods = nlohmann::json::parse(contentOf(folder_ / "t.json"))["methods"];
  for (const char* name : {"symmetry", "anew"}) EXPECT_GE(methods[name]["right_rate"].get<double>(), 0.99) << name;
  EXPECT_EQ(methods["symmetry"]["median_angle_deg"], methods["anew"]["median_angle_deg"]) << "the same poses";
  EXPECT_EQ(run((folder_ / ".") + " -around 120"), 2);
}

TEST_F(EvaluateRegistration, RunsOneMethodUnderHarderConditions) {
  ASSERT_EQ(
      run((folder_ / ".") + " -points 2000 -num_views 1 -methods frames,rotations -noise 0.01 -missing 0.2 -quiet"), 0)
      << error_;
  EXPECT_NE(output_.find("frames"), std::string::npos);
  EXPECT_NE(output_.find("rotations"), std::string::npos);
  EXPECT_EQ(output_.find("pca"), std::string::npos);
  EXPECT_EQ(run((folder_ / ".") + " -methods nothing"), 2);
  EXPECT_EQ(run(folder_ / "nowhere"), 1);
}

}  // namespace
