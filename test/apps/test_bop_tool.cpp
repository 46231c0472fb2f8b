#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lathe_mesh.h"
#include "shapes/turning_shapes.h"
#include "tool_run.h"

namespace {

using namespace pcl_symmetry;
using nlohmann::json;

std::string offOf(const test::TurningShape& shape) {
  std::string text =
      "OFF\n" + std::to_string(shape.vertices.size()) + " " + std::to_string(shape.triangles.size()) + " 0\n";
  for (const Eigen::Vector3d& v : shape.vertices)
    text += std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  for (const Eigen::Vector3i& t : shape.triangles)
    text += "3 " + std::to_string(t.x()) + " " + std::to_string(t.y()) + " " + std::to_string(t.z()) + "\n";
  return text;
}

class BopTool : public ToolTest {
protected:
  BopTool() : ToolTest(BOP_TOOL) {}

  json infoOf(const std::string& arguments) {
    EXPECT_EQ(run(arguments + " -quiet -json " + json_), 0) << error_;
    return json::parse(contentOf(json_));
  }

  static Eigen::Matrix4d matrixOf(const json& numbers) {
    const auto values = numbers.get<std::vector<double>>();
    EXPECT_EQ(values.size(), 16u);
    return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  }

  const std::string json_ = folder_ / "models_info.json";
  const std::string box_ = folder_.write("obj_000003.off", boxOFF());
  const std::string vase_ = folder_.write("obj_000012.off", vaseOFF());
};

TEST_F(BopTool, DescribesABoxAsTheBenchmarkDoes) {
  const json info = infoOf(box_);
  ASSERT_EQ(info.size(), 1u);
  const json& box = info.at("3");
  EXPECT_EQ(box["diameter"], 2.0 * std::sqrt(1.0 + 1.5 * 1.5 + 4.0)) << "of the vertices, exactly";
  EXPECT_EQ(box["min_x"], -1.0);
  EXPECT_EQ(box["min_y"], -1.5);
  EXPECT_EQ(box["min_z"], -2.0);
  EXPECT_EQ(box["size_x"], 2.0);
  EXPECT_EQ(box["size_y"], 3.0);
  EXPECT_EQ(box["size_z"], 4.0);
  EXPECT_FALSE(box.contains("symmetries_continuous")) << "what there is none of is left out";
  ASSERT_EQ(box["symmetries_discrete"].size(), 3u);
  for (const json& symmetry : box["symmetries_discrete"]) {
    const Eigen::Matrix4d T = matrixOf(symmetry);
    EXPECT_EQ(T.row(3), Eigen::RowVector4d(0, 0, 0, 1)) << "row by row";
    EXPECT_NEAR(T.determinant(), 1.0, 1e-9);
    EXPECT_NEAR(T.trace(), 0.0, 1e-9) << "by pi";
    EXPECT_LT((T.cwiseAbs() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 0.02) << "about a coordinate axis";
  }
}

TEST_F(BopTool, GivesBodiesOfRevolutionAnAxisAndCylindersAFlip) {
  const json vase = infoOf(vase_).at("12");
  EXPECT_FALSE(vase.contains("symmetries_discrete"));
  ASSERT_EQ(vase["symmetries_continuous"].size(), 1u);
  const auto axis = vase["symmetries_continuous"][0]["axis"].get<std::vector<double>>();
  const auto offset = vase["symmetries_continuous"][0]["offset"].get<std::vector<double>>();
  EXPECT_NEAR(std::abs(axis[2]), 1.0, 1e-4);
  EXPECT_NEAR(offset[0], 0.0, 0.01);
  EXPECT_NEAR(offset[1], 0.0, 0.01);

  const json cylinder = infoOf(folder_.write("can.off", offOf(test::cylinderShape()))).at("1");
  ASSERT_EQ(cylinder["symmetries_continuous"].size(), 1u);
  ASSERT_EQ(cylinder["symmetries_discrete"].size(), 1u);
  const Eigen::Matrix4d flip = matrixOf(cylinder["symmetries_discrete"][0]);
  EXPECT_NEAR(flip(2, 2), -1.0, 1e-3) << "end over end";
}

TEST_F(BopTool, GivesASphereThreeAxesAndAnAsymmetricModelNothing) {
  const json sphere = infoOf(folder_.write("ball.off", sphereOFF())).at("1");
  EXPECT_EQ(sphere["symmetries_continuous"].size(), 3u);
  EXPECT_FALSE(sphere.contains("symmetries_discrete"));
  const json tetrahedron = infoOf(folder_.write("m7.off", tetrahedronOFF())).at("7");
  EXPECT_FALSE(tetrahedron.contains("symmetries_continuous"));
  EXPECT_FALSE(tetrahedron.contains("symmetries_discrete"));
  EXPECT_NE(output_.find("group C1"), std::string::npos) << output_;
}

TEST_F(BopTool, FindsPropellersThatNoPlaneShows) {
  const json propeller = infoOf(folder_.write("fan.off", offOf(test::propellerShape(3, true)))).at("1");
  EXPECT_EQ(propeller["symmetries_discrete"].size(), 2u);
  EXPECT_NE(output_.find("fold 3"), std::string::npos) << output_;
}

TEST_F(BopTool, NumbersModelsAsTheirFilesOrElseByTheFirstFreeNumber) {
  const std::string zero = folder_.write("obj_000000.off", boxOFF()), plain = folder_.write("vase.off", vaseOFF());
  const json info = infoOf(vase_ + " " + box_ + " " + plain + " " + zero + " -points 1000");
  EXPECT_EQ(info.size(), 4u);
  for (const char* key : {"0", "1", "3", "12"}) EXPECT_TRUE(info.contains(key)) << key;
  const std::string text = contentOf(json_);
  EXPECT_LT(text.find("\"3\""), text.find("\"12\"")) << "by number";
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6) << "a line for each";
}

TEST_F(BopTool, RefusesTwoModelsOfOneNumber) {
  const std::string other = folder_.write("copy_3.off", boxOFF());
  EXPECT_EQ(run(box_ + " " + other + " -json " + json_), 2);
  EXPECT_NE(error_.find("both model 3"), std::string::npos) << error_;
}

TEST_F(BopTool, TakesClouds) {
  const test::Shape shape = test::prismShape(6, 0.8).sampled(3000, 1);
  std::string pcd =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3001\nHEIGHT 1\n"
      "POINTS 3001\nDATA ascii\nnan nan nan\n";
  for (Eigen::Index i = 0; i < shape.points.cols(); ++i) {
    for (int k = 0; k < 3; ++k) pcd += std::to_string(shape.points(k, i)) + (k < 2 ? " " : "\n");
  }
  EXPECT_EQ(infoOf(folder_.write("obj_6.pcd", pcd)).at("6")["symmetries_discrete"].size(), 11u);
}

TEST_F(BopTool, GivesTheSameBytesForAnyNumberOfThreads) {
  std::string expected;
  for (const char* threads : {"1", "2", "8"}) {
    ASSERT_EQ(run(box_ + " " + vase_ + " -points 2000 -threads " + threads + " -json " + json_), 0) << error_;
    if (expected.empty()) expected = contentOf(json_);
    EXPECT_EQ(contentOf(json_), expected) << threads << " threads";
  }
}

TEST_F(BopTool, AnswersBadInputWithOneLineAndAnExitCodeAndNoFile) {
  const std::string point = folder_.write("point.pcd",
                                          "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
                                          "HEIGHT 1\nPOINTS 2\nDATA ascii\n1 2 3\n1 2 3\n");
  EXPECT_EQ(run(box_ + " " + point + " -quiet -json " + json_), 1);
  EXPECT_NE(error_.find("point.pcd: "), std::string::npos) << error_;
  EXPECT_NE(error_.find("1 distinct point, at least 20 are needed"), std::string::npos) << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  const std::string flat = folder_.write("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  EXPECT_EQ(run(flat + " -quiet -json " + json_), 1);
  EXPECT_NE(error_.find("flat.off: "), std::string::npos) << error_;
  EXPECT_EQ(run((folder_ / "missing.ply") + " -json " + json_), 1);
  const auto names = folder_.names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "models_info.json"), 0);
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run(box_ + " -jsn a.json"), 2);
  EXPECT_NE(error_.find("did you mean -json?"), std::string::npos) << error_;
  EXPECT_EQ(run(box_ + " -feature 2"), 2);
  EXPECT_EQ(run("-h"), 0);
  EXPECT_NE(output_.find("pcl_symmetry_bop models/obj_*.ply"), std::string::npos) << output_;
}

}  // namespace
