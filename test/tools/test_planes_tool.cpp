/// The tool of planes, and what it shows of all tools: many inputs, standard streams, names, full disks.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "io/shape_input.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

class PlanesTool : public ToolTest {
protected:
  PlanesTool() : ToolTest(toolPath("planes")) {}

  const std::string box_ = folder_.write("box.off", boxOFF());
  const std::string tetrahedron_ = folder_.write("t.off", tetrahedronOFF());
};

TEST_F(PlanesTool, WritesTheProfileOfABodyOfRevolution) {
  const std::string vase =
      folder_.write("vase.off", latheOFF({{0.5, 0}, {0.7, 0.3}, {0.5, 0.8}, {0.3, 1.0}, {0.4, 1.4}}, 90));
  ASSERT_EQ(run(vase + " -profile " + (folder_ / "p.csv")), 0) << error_;
  std::istringstream table(contentOf(folder_ / "p.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "radius,height,spread,count");
  double greatest = 0.0;
  int count = 0;
  for (; std::getline(table, line); ++count) greatest = std::max(greatest, std::stod(line));
  EXPECT_GT(count, 60);
  EXPECT_NEAR(greatest, 0.7, 0.02);
  ASSERT_EQ(run(vase + " -profile " + (folder_ / "p.svg")), 0) << error_;
  EXPECT_EQ(contentOf(folder_ / "p.svg").rfind("<svg ", 0), 0u);
  EXPECT_EQ(run(vase + " -profile " + (folder_ / "p.txt")), 2);
  EXPECT_TRUE(fails(box_ + " -profile " + (folder_ / "p.csv"), 1, "no body of revolution"));
}

TEST_F(PlanesTool, FindsTheThreePlanesOfABox) {
  EXPECT_EQ(reportOf(box_ + " -as_published")["planes"][0]["kind"], "approximate");
  const nlohmann::json report = reportOf(box_);
  ASSERT_EQ(report["planes"].size(), 3u);
  std::array<int, 3> along{};
  for (const auto& plane : report["planes"]) {
    const auto c = plane["coefficients"].get<std::vector<double>>();
    ASSERT_EQ(c.size(), 4u);
    EXPECT_NEAR(c[0] * c[0] + c[1] * c[1] + c[2] * c[2], 1.0, 1e-9);
    EXPECT_NEAR(c[3], 0.0, 0.005);
    for (int axis = 0; axis < 3; ++axis) along[axis] += std::abs(c[axis]) > std::cos(0.0017) ? 1 : 0;
    EXPECT_GT(plane["support"].get<double>(), 0.98);
    EXPECT_EQ(plane["kind"], "symmetry");
    EXPECT_GT(plane["confidence"].get<double>(), 0.9);
    EXPECT_LE(plane["confidence"].get<double>(), 1.0);
    EXPECT_NEAR(plane["seen"].get<double>(), 1.0, 1e-6);
  }
  EXPECT_EQ(along, (std::array<int, 3>{1, 1, 1})) << "each axis once, within 0.1 degrees";
  EXPECT_TRUE(report["axes"].is_array() && report["axes"].empty());
  EXPECT_TRUE(report["centers"].is_array() && report["centers"].empty());
  EXPECT_EQ(report["partial"], false);
  EXPECT_GT(report["timing_ms"]["total"].get<double>(), 0.0);
  EXPECT_NE(output_.find("symmetry"), std::string::npos);
}

/// A box of 1 x 0.8 x 0.6 m at map coordinates, where the spacing of float is half a meter; its planes are oblique.
TEST_F(PlanesTool, KeepsCoordinatesBeyondFloatPrecision) {
  const Eigen::Vector3d half(0.5, 0.4, 0.3);
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(500000.3, 5000000.7, 100.2) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const std::string far = folder_.write("far.off", boxOFF(pose * boxCorners(half)));
  const nlohmann::json report = reportOf(far + " -support " + (folder_ / "s.pcd"));
  ASSERT_EQ(report["planes"].size(), 3u);
  std::istringstream table(output_);
  std::string line;
  std::getline(table, line);
  Eigen::Vector3i along = Eigen::Vector3i::Zero();
  for (const auto& plane : report["planes"]) {
    const auto c = plane["coefficients"].get<std::vector<double>>();
    const Eigen::Vector3d n(c[0], c[1], c[2]);
    along += ((pose.linear().transpose() * n).array().abs() > 0.99).cast<int>().matrix();
    EXPECT_NEAR(n.dot(pose.translation()) + c[3], 0.0, 1e-3) << "through the middle of the box";
    double number = 0.0, d = 0.0;
    Eigen::Vector3d printed;
    std::getline(table, line);
    ASSERT_TRUE(std::istringstream(line) >> number >> printed.x() >> printed.y() >> printed.z() >> d) << line;
    EXPECT_NEAR(printed.dot(pose.translation()) + d, 0.0, 2e-5) << "few digits, and still the plane at the points";
  }
  EXPECT_EQ(along, Eigen::Vector3i::Ones());
  const Shape saved = loadShape(folder_ / "s.pcd");
  for (const pcl::PCLPointField& field : saved.cloud.fields)
    if (field.name == "x") {
      EXPECT_EQ(field.datatype, pcl::PCLPointField::FLOAT64);
    }
  const Eigen::Vector3d first = (*saved.points)[0].getVector3fMap().cast<double>() + saved.shift;
  EXPECT_LT(((pose.inverse() * first).cwiseAbs() - half).maxCoeff(), 1e-6) << "on the box, in the input frame";
}

TEST_F(PlanesTool, SaysNone) {
  const nlohmann::json answer = reportOf(tetrahedron_ + " -quiet");
  EXPECT_EQ(output_.find("no symmetry plane\nbest plane "), 0u) << output_;
  EXPECT_EQ(error_, "");
  EXPECT_TRUE(answer["planes"].empty());
  EXPECT_LT(answer["best"]["share"].get<double>(), 0.9);
  EXPECT_GT(answer["best"]["deviation"].get<double>(), answer["tolerance"].get<double>());
  ASSERT_EQ(run(tetrahedron_ + " -quiet --approximate"), 0);
  EXPECT_NE(output_.find("approximate"), std::string::npos);
}

TEST_F(PlanesTool, WritesTheSupportOfEveryPointAndKeepsItsFields) {
  const std::string input = folder_.write("c.pcd", [] {
    std::string text =
        "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 1201\nHEIGHT 1\n"
        "VIEWPOINT 1 2 3 1 0 0 0\nPOINTS 1201\nDATA ascii\nnan nan nan 7\n";
    for (int i = 0; i < 1200; ++i) {
      const double u = std::fmod(i * 0.754877666, 1.0), v = std::fmod(i * 0.569840291, 1.0), s = i % 2 ? 1 : -1;
      const double p[3][3] = {
          {s, 3 * v - 1.5, 4 * u - 2}, {2 * u - 1, 1.5 * s, 4 * v - 2}, {2 * u - 1, 3 * v - 1.5, 2 * s}};
      const auto* q = p[i % 3];
      text += std::to_string(q[0]) + " " + std::to_string(q[1]) + " " + std::to_string(q[2]) + " " + std::to_string(i) +
              "\n";
    }
    return text;
  }());
  const std::size_t num_planes = reportOf(input + " -support " + (folder_ / "s.pcd"))["planes"].size();
  ASSERT_GE(num_planes, 1u);
  const Shape shape = loadShape(folder_ / "s.pcd");
  std::vector<std::string> names;
  for (const auto& field : shape.cloud.fields) names.push_back(field.name);
  for (const char* name : {"x", "y", "z", "label", "support_1"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  EXPECT_EQ(std::count_if(names.begin(), names.end(), [](const auto& n) { return n.rfind("support_", 0) == 0; }),
            static_cast<std::ptrdiff_t>(num_planes));
  EXPECT_EQ(shape.points->size(), 1201u);
  EXPECT_EQ(shape.sensor_origin.head<3>(), Eigen::Vector3f(1, 2, 3));
  const auto& field = *std::find_if(shape.cloud.fields.begin(), shape.cloud.fields.end(),
                                    [](const auto& f) { return f.name == "support_1"; });
  const auto support = [&](std::size_t i) {
    float value;
    std::memcpy(&value, &shape.cloud.data[i * shape.cloud.point_step + field.offset], sizeof(value));
    return value;
  };
  EXPECT_TRUE(std::isnan(support(0)));
  double sum = 0.0;
  for (std::size_t i = 1; i <= 1200; ++i) sum += support(i) / 1200;
  EXPECT_GT(sum, 0.9);
}

TEST_F(PlanesTool, ReportsAnAxisOfRevolution) {
  const std::string cylinder =
      folder_.write("cylinder.off", latheOFF({{0.001, -1.0}, {0.6, -1.0}, {0.6, 1.0}, {0.001, 1.0}}, 128));
  const nlohmann::json report = reportOf(cylinder);
  ASSERT_EQ(report["axes"].size(), 1u);
  const auto& axis = report["axes"][0];
  const auto direction = axis["direction"].get<std::vector<double>>(), point = axis["point"].get<std::vector<double>>();
  EXPECT_GT(std::abs(direction.at(2)), std::cos(0.01));
  EXPECT_LT(std::hypot(point.at(0), point.at(1)), 0.01);
  EXPECT_GE(axis["confidence"].get<double>(), 0.5);
  EXPECT_GT(axis["support"].get<double>(), 0.9);
  EXPECT_GT(axis["score"].get<double>(), 0.9);
  EXPECT_TRUE(report["centers"].empty());
  ASSERT_EQ(report["planes"].size(), 1u);
  EXPECT_GT(std::abs(report["planes"][0]["coefficients"][2].get<double>()), std::cos(0.01));
  EXPECT_NE(output_.find("axis of revolution"), std::string::npos);

  const std::string ball = folder_.write("ball.off", sphereOFF());
  const nlohmann::json round = reportOf(ball);
  ASSERT_EQ(round["centers"].size(), 1u);
  EXPECT_TRUE(round["planes"].empty());
  EXPECT_TRUE(round["axes"].empty());
  for (const double x : round["centers"][0]["point"].get<std::vector<double>>()) EXPECT_NEAR(x, 0.0, 0.01);
}

TEST_F(PlanesTool, AnswersBadInputWithOneLineAndAnExitCode) {
  const auto oneLine = [&] { return std::count(error_.begin(), error_.end(), '\n') == 1; };
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"garbage.pcd", "not a point cloud at all"},
           {"one.pcd",
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS "
            "2\nDATA ascii\n1 2 3\n1 2 3\n"}}) {
    EXPECT_EQ(run(folder_.write(name, content) + " -quiet -json " + (folder_ / "never.json")), 1) << name;
    EXPECT_TRUE(oneLine()) << name << ": " << error_;
    EXPECT_NE(error_.find(name), std::string::npos) << error_;
  }
  EXPECT_EQ(contentOf(folder_ / "never.json"), "");
  for (const char* output : {" -json ", " -csv ", " -support "}) {
    EXPECT_EQ(run(box_ + output + "missing/out.pcd"), 1);
    EXPECT_EQ(output_, "") << "refused before the work";
  }
  EXPECT_EQ(run(box_ + " -quiet -json /dev/null"), 0) << error_;
  EXPECT_EQ(run(folder_ / "missing.pcd"), 1);
  EXPECT_TRUE(fails(box_ + " -min_confidence 2", 2, "min_confidence"));
  EXPECT_EQ(run(box_ + " -nonsense"), 2);
  EXPECT_TRUE(fails(box_ + " -png out.jpg", 2, "-png = out.jpg, must end in .png"));
  EXPECT_EQ(run("--version"), 0);
  EXPECT_EQ(output_.rfind("pcl_symmetry_planes ", 0), 0u) << output_;
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("-h"), 0);
  EXPECT_NE((output_ + error_).find("pcl_symmetry_planes chair.pcd"), std::string::npos);
}

/// A tool with a folder "in" of two boxes and a file that is no shape.
class PlanesPipelines : public ToolTest {
protected:
  PlanesPipelines() : ToolTest(toolPath("planes")) {
    std::filesystem::create_directory(folder_ / "in");
    folder_.write("in/a.off", boxOFF(1.5, 2.0));
    folder_.write("in/b.off", "no shape");
    folder_.write("in/c.off", boxOFF(1.5, 3.0));
  }

  const std::string in_ = folder_ / "in";
};

TEST_F(PlanesPipelines, TakeAFolder) {
  EXPECT_EQ(run(in_ + " -quiet -points 2000 -csv " + (folder_ / "t.csv") + " -json " + (folder_ / "t.jsonl") +
                " -support '" + (folder_ / "{}_support.pcd") + "'"),
            1);
  EXPECT_EQ(output_, "");
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  EXPECT_NE(error_.find("b.off: does not begin with OFF"), std::string::npos) << error_;
  const auto found = jsonLines(contentOf(folder_ / "t.jsonl"));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0]["planes"].size(), 3u);
  EXPECT_TRUE(found[1].contains("error"));
  EXPECT_EQ(found[2]["file"], in_ + "/c.off");
  const std::string csv = contentOf(folder_ / "t.csv");
  EXPECT_EQ(csv.rfind("file,number,kind,a,b,c,d,", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_EQ(loadShape(folder_ / "a_support.pcd").points->size(), 2000u);
  EXPECT_EQ(loadShape(folder_ / "c_support.pcd").points->size(), 2000u);
  // The same as one by one.
  ASSERT_EQ(run(in_ + "/c.off -quiet -points 2000 -json " + (folder_ / "c.json")), 0);
  nlohmann::json alone = nlohmann::json::parse(contentOf(folder_ / "c.json")), among = found[2];
  alone.erase("timing_ms");
  among.erase("timing_ms");
  EXPECT_EQ(alone, among);
}

TEST_F(PlanesPipelines, PrintLinesOfJSONWhereNoFileIsNamed) {
  ASSERT_EQ(run(in_ + "/a.off " + in_ + "/c.off -quiet -points 2000"), 0) << error_;
  EXPECT_EQ(jsonLines(output_).size(), 2u);
  EXPECT_TRUE(fails(in_ + " -png out.png", 2, "must hold {}"));
  EXPECT_TRUE(fails(in_ + " -resume", 2, "-resume needs -json FILE"));
}

TEST_F(PlanesPipelines, ReadStandardInputAndWriteStandardOutput) {
  ASSERT_EQ(run("- -quiet -points 2000 <" + in_ + "/a.off"), 0) << error_;
  EXPECT_NE(output_.find("symmetry"), std::string::npos);
  ASSERT_EQ(run("- -quiet -points 2000 -json - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(nlohmann::json::parse(output_)["file"], "-");
  ASSERT_EQ(run("- -quiet -points 2000 -support - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(output_.rfind("# .PCD", 0), 0u);
  ASSERT_EQ(run("- -quiet -points 2000 -csv - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(output_.rfind("file,number", 0), 0u);
  EXPECT_EQ(run("- -quiet -csv - -json - <" + in_ + "/a.off"), 2);
  EXPECT_TRUE(fails("- -quiet <" + in_ + "/b.off", 1, "standard input: is of no known kind"));
  EXPECT_TRUE(fails("- -quiet </dev/null", 1, "standard input: is empty"));
  const std::string cut = folder_.write("cut.off", "OFF\n3 1 0\n0 0 0\n0 0 0\n");
  EXPECT_TRUE(fails("- -quiet <" + cut, 1, "standard input: x of vertex 2 is missing"));
}

/// Names in UTF-8, and bytes that are none: file names are bytes.
TEST_F(PlanesPipelines, TakeNamesInAnyLanguage) {
  const std::string folder = folder_ / "W\xc3\xbcrfel \xe7\xab\x8b\xe6\x96\xb9";
  std::filesystem::create_directory(folder);
  const std::string box = contentOf(in_ + "/a.off");
  for (const std::string name : {"\xd0\xba\xd1\x83\xd0\xb1 1", "no \xff text", "'quotes' & more"}) {
    const std::string path = folder + "/" + name;
    std::ofstream(path + ".off", std::ios::binary) << box;
    std::string quoted;
    for (const char c : path) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    const auto out = [&](const std::string& ending) { return "'" + quoted + ending + "'"; };
    ASSERT_EQ(run(out(".off") + " -quiet -points 2000 -json " + out(".json") + " -csv " + out(".csv") + " -support " +
                  out("_support.ply") + " -html " + out(".html")),
              0)
        << name << ": " << error_;
    EXPECT_EQ(nlohmann::json::parse(contentOf(path + ".json"))["planes"].size(), 3u) << name;
    EXPECT_EQ(loadShape(path + "_support.ply").points->size(), 2000u) << name;
    EXPECT_NE(contentOf(path + ".html"), "") << name;
  }
  ASSERT_EQ(run("'" + folder + "' -quiet -points 2000"), 0) << error_;
  EXPECT_EQ(jsonLines(output_).size(), 6u) << "three boxes, three clouds with support";
}

TEST_F(PlanesPipelines, SayThatStandardOutputIsFull) {
  for (const std::string flags : {"-json -", "-csv -", "-support -", ""}) {
    const int status = std::system((toolPath("planes") + " " + in_ + "/a.off -quiet -points 2000 " + flags +
                                    " >/dev/full 2>" + (folder_ / "stderr"))
                                       .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << flags;
    EXPECT_NE(contentOf(folder_ / "stderr").find("standard output"), std::string::npos) << flags;
  }
}

}  // namespace
