#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"
#include "common/shape_input/shape_input.h"

namespace {

using namespace pcl_symmetry::apps;
using nlohmann::json;

/// The tool on a folder with a box (three planes), a vase (one axis) and a tetrahedron (nothing).
class EvaluatePlanes : public ToolTest {
protected:
  EvaluatePlanes() : ToolTest(toolPath("evaluate")) {
    boost::filesystem::create_directories(folder_ / "meshes");
    folder_.write("meshes/box.off", boxOFF());
    folder_.write("meshes/vase.off", vaseOFF());
    folder_.write("meshes/tetrahedron.off", tetrahedronOFF());
  }

  /// The references are found once for each test.
  int evaluate(const std::string& arguments) {
    const std::string rows = arguments.find("-rows") == std::string::npos ? " -rows whole,noise,scan" : "";
    return run("planes " + meshes_ + " -references " + (folder_ / "references.json") + " -json " + json_ + rows + " " +
               arguments);
  }
  json summary() const { return json::parse(contentOf(json_)); }
  std::vector<json> groups() const { return summary()["groups"]; }

  static std::vector<std::string> linesOf(const std::string& path) {
    std::istringstream text(contentOf(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }

  const std::string meshes_ = folder_ / "meshes", json_ = folder_ / "summary.json";
};

TEST_F(EvaluatePlanes, PrintsATableAndWritesRowsForCloudsAndModels) {
  ASSERT_EQ(evaluate("-noise 0,0.005 -num_views 1 -points 3000 -csv " + (folder_ / "c.csv") + " -model_csv " +
                     (folder_ / "m.csv") + " -curve_csv " + (folder_ / "p.csv") + " -png " + (folder_ / "p.png")),
            0)
      << error_;
  const json report = summary();
  EXPECT_EQ(report["num_models"], (json{{"symmetric", 2}, {"nearly_symmetric", 0}, {"asymmetric", 1}}));
  ASSERT_EQ(report["groups"].size(), 3u);
  const json& whole = report["groups"][0];
  EXPECT_EQ(whole["group"], "whole, noise 0");
  EXPECT_EQ(whole["num_symmetric"], 2);
  EXPECT_EQ(whole["num_asymmetric"], 1);
  EXPECT_EQ(whole["num_axes"], 1);
  EXPECT_EQ(whole["decisions"]["decided_right"]["count"], 2);
  EXPECT_EQ(whole["decisions"]["asymmetric_called"]["total"], 1);
  EXPECT_GT(whole["decisions"]["decided_right"]["low"].get<double>(), 0.3) << "Wilson's interval of 2 of 2: 0.34";
  EXPECT_LT(whole["decisions"]["decided_right"]["low"].get<double>(), 0.4);
  EXPECT_EQ(whole["reliability"]["bins"].size(), 10u);
  EXPECT_NE(output_.find("% of 2 ("), std::string::npos) << "intervals are printed";
  EXPECT_EQ(whole["first_rate"], 1.0) << "a box and a vase without noise";
  EXPECT_LT(whole["angle_deg"]["median"].get<double>(), 1.0);
  EXPECT_GT(whole["timing_ms"]["median"].get<double>(), 0.0);
  EXPECT_NE(output_.find("whole, noise 0.005"), std::string::npos);
  EXPECT_NE(output_.find("scan, noise 0"), std::string::npos);

  const auto clouds = linesOf(folder_ / "c.csv"), models = linesOf(folder_ / "m.csv");
  ASSERT_EQ(clouds.size(), 1u + 9u);
  ASSERT_EQ(models.size(), 1u + 3u);
  EXPECT_EQ(models[1].substr(0, 4), "box,");
  for (const std::string& row : models)
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(models[0].begin(), models[0].end(), ','));
  EXPECT_NE(std::find_if(clouds.begin(), clouds.end(),
                         [](const std::string& row) { return row.find("tetrahedron,asymmetric") == 0; }),
            clouds.end());
  EXPECT_EQ(linesOf(folder_ / "p.csv").front(), "group,score,precision,recall");
  EXPECT_EQ(contentOf(folder_ / "p.png").substr(1, 3), "PNG");
}

TEST_F(EvaluatePlanes, KeepsReferencesAndRefusesThoseOfOtherThresholds) {
  ASSERT_EQ(evaluate("-no_detect -max 1"), 0) << error_;
  const json box = json::parse(contentOf(folder_ / "references.json"))["models"];
  ASSERT_EQ(box.size(), 1u);
  EXPECT_EQ(box["meshes/box.off"]["planes"].size(), 3u);
  ASSERT_EQ(evaluate("-no_detect"), 0) << error_;
  const json all = json::parse(contentOf(folder_ / "references.json"))["models"];
  EXPECT_EQ(all.size(), 3u);
  EXPECT_EQ(all["meshes/box.off"], box["meshes/box.off"]) << "was read, not searched again";
  EXPECT_EQ(all["meshes/vase.off"]["axes"].size(), 1u);
  EXPECT_EQ(all["meshes/tetrahedron.off"]["kind"], "asymmetric");
  EXPECT_EQ(evaluate("-no_detect -tolerance 0.02"), 1);
  EXPECT_NE(error_.find("tolerance"), std::string::npos) << error_;
}

TEST_F(EvaluatePlanes, JudgesPlanesThatOthersWrote) {
  const std::string exported = folder_ / "clouds";
  ASSERT_EQ(evaluate("-no_detect -noise 0 -num_views 2 -points 500 -export " + exported), 0) << error_;
  const json truth = json::parse(contentOf(exported + "/ground_truth.json"))["clouds"];
  ASSERT_EQ(truth.size(), 9u);
  const Shape scan = loadShape(exported + "/box_scan_1_noise_0.pcd");
  EXPECT_GT(scan.sensor_origin.head<3>().norm(), 0.0f);
  EXPECT_EQ(loadShape(exported + "/box_whole_noise_0.pcd").points->size(), 500u);

  boost::filesystem::create_directories(folder_ / "right");
  boost::filesystem::create_directories(folder_ / "wrong");
  for (const auto& [name, cloud] : truth.items()) {
    std::string lines = "# planes\n";
    for (const json& plane : cloud["planes"]) {
      for (const json& c : plane["coefficients"]) lines += c.dump() + " ";
      lines += "0.5\n";
    }
    // Half of the files in each form.
    if (cloud["axes"].empty()) {
      folder_.write("right/" + name + ".txt", lines);
    } else {
      folder_.write("right/" + name + ".json", json{{"planes", json::array()}, {"axes", cloud["axes"]}}.dump());
    }
    const double diagonal = cloud["diagonal"], x = cloud["center"][0];
    const json wrong{{"coefficients", {1.0, 0.0, 0.0, -x - 0.3 * diagonal}}, {"score", 0.9}};
    folder_.write("wrong/" + name + ".json", json{{"planes", {wrong}}}.dump());
  }
  const std::string same = "-noise 0 -num_views 2 -points 500 -planes ";
  ASSERT_EQ(evaluate(same + (folder_ / "right")), 0) << error_;
  for (const json& group : groups()) {
    EXPECT_EQ(group["first_rate"], 1.0);
    EXPECT_EQ(group["recall"], 1.0);
    EXPECT_EQ(group["axis_rate"], 1.0);
    EXPECT_EQ(group["decisions"]["decided_right"]["rate"], 1.0);
    EXPECT_EQ(group["decisions"]["false_per_cloud"], 0.0);
    EXPECT_EQ(group["decisions"]["asymmetric_called"]["rate"], 0.0);
    EXPECT_EQ(group["average_precision"], 1.0);
    EXPECT_LT(group["angle_deg"]["p90"].get<double>(), 1e-4);
    EXPECT_EQ(group["num_failed"], 0);
  }
  ASSERT_EQ(evaluate(same + (folder_ / "wrong")), 0) << error_;
  for (const json& group : groups()) {
    EXPECT_EQ(group["five_rate"], 0.0);
    EXPECT_EQ(group["decisions"]["decided_right"]["rate"], 0.0);
    EXPECT_EQ(group["decisions"]["false_per_cloud"], 1.0);
    EXPECT_EQ(group["decisions"]["asymmetric_called"]["rate"], 1.0);
    const int num_false = group["group"] == "scan, noise 0" ? 6 : 0;  // three models from two sides
    EXPECT_EQ(group["decisions"]["num_false_contradicted"].get<int>() +
                  group["decisions"]["num_false_undecidable"].get<int>(),
              num_false);
    EXPECT_EQ(group["average_precision"], 0.0);
  }
  boost::filesystem::remove(folder_ / "right/box_whole_noise_0.txt");
  ASSERT_EQ(evaluate(same + (folder_ / "right")), 0) << error_;
  EXPECT_EQ(summary()["failed"], json{"box_whole_noise_0"});
  EXPECT_NE(error_.find("box_whole_noise_0"), std::string::npos);
  folder_.write("right/box_whole_noise_0.txt", "1 0 zero 0\n");
  EXPECT_EQ(evaluate(same + (folder_ / "right")), 1);
  EXPECT_NE(error_.find("box_whole_noise_0.txt: coefficient of plane 1 = zero"), std::string::npos) << error_;
}

TEST_F(EvaluatePlanes, SweepsVaryOneThing) {
  const std::string empty = folder_ / "empty";
  boost::filesystem::create_directories(empty);
  const std::string common = " -max 1 -points 500 -planes " + empty + " -csv " + (folder_ / "c.csv");
  const auto labels = [&] {
    std::vector<std::string> found;
    for (const json& group : groups()) found.push_back(group["group"]);
    return found;
  };
  ASSERT_EQ(evaluate("-sweep points -point_counts 200,400" + common), 0) << error_;
  EXPECT_EQ(labels(), (std::vector<std::string>{"whole, points 200", "whole, points 400"}));
  EXPECT_NE(contentOf(folder_ / "c.csv").find("box_whole_points_400,\"whole, points 400\",400,0,0"), std::string::npos);
  ASSERT_EQ(evaluate("-sweep missing -missing 0,0.3" + common), 0) << error_;
  EXPECT_NE(contentOf(folder_ / "c.csv").find("box_whole_missing_0.3,\"whole, missing 0.3\",350,0,0.3"),
            std::string::npos);
  ASSERT_EQ(evaluate("-sweep views -num_views 12" + common), 0) << error_;
  for (const std::string& label : labels())
    EXPECT_TRUE(label == "scan, no plane" || label.find(" deg") != std::string::npos) << label;
  EXPECT_EQ(summary()["failed"].size(), 12u);
}

TEST_F(EvaluatePlanes, OneOperatingPointDecides) {
  boost::filesystem::create_directories(folder_ / "found");
  const json plane{{"coefficients", {1.0, 0.0, 0.0, 0.0}}, {"score", 0.6}};
  folder_.write("found/tetrahedron_whole_noise_0.json", json{{"planes", {plane}}}.dump());
  const std::string common = "-rows whole -max 2 -first 1 -planes " + (folder_ / "found");
  const auto numCalled = [&](const std::string& arguments) {
    EXPECT_EQ(evaluate(common + arguments), 0) << error_;
    return groups()[0]["decisions"]["asymmetric_called"]["count"].get<int>();
  };
  EXPECT_EQ(numCalled(""), 1);
  EXPECT_EQ(numCalled(" -min_confidence 0.7"), 0);
  json possible = plane;
  possible["kind"] = "possible";
  folder_.write("found/tetrahedron_whole_noise_0.json", json{{"planes", {possible}}}.dump());
  EXPECT_EQ(numCalled(""), 0) << "what may be a symmetry is not called one";
  boost::filesystem::remove(folder_ / "found/tetrahedron_whole_noise_0.json");
  folder_.write("found/tetrahedron_whole_noise_0.txt", "1 0 0 0\n");
  EXPECT_EQ(numCalled(" -min_confidence 1"), 1) << "an order is no probability";
  EXPECT_EQ(groups()[0]["reliability"]["num_answers"], 0);
}

TEST_F(EvaluatePlanes, RowsAreChosenByName) {
  boost::filesystem::create_directories(folder_ / "empty");
  const std::string common = " -max 1 -points 300 -num_views 1 -planes " + (folder_ / "empty");
  ASSERT_EQ(evaluate("-rows moved,crop,sampling" + common), 0) << error_;
  std::vector<std::string> labels;
  for (const json& group : groups()) labels.push_back(group["group"]);
  EXPECT_EQ(labels, (std::vector<std::string>{"moved scan, noise 0", "cut off, 0.05", "cut off, 0.2", "cut off, 0.5",
                                              "whole, random", "whole, voxel", "whole, scanners", "whole, rings"}));
  EXPECT_EQ(evaluate("-rows whole,half" + common), 2);
  EXPECT_NE(error_.find("half"), std::string::npos);
}

TEST_F(EvaluatePlanes, FoldsSplitByLeafClass) {
  boost::filesystem::create_directories(folder_ / "psb");
  for (const char* name : {"m1", "m2", "m3", "m4"}) folder_.write(std::string("psb/") + name + ".off", boxOFF());
  // "thing" names no model: the leaf classes are round (0), flat (1) and long (2).
  const std::string classes =
      folder_.write("c.cla", "PSB 1\n4 4\n\nthing 0 0\n\nround thing 1\n4\n\nflat thing 2\n1\n2\n\nlong thing 1\n3\n");
  const auto models = [&](const std::string& arguments) {
    EXPECT_EQ(run("planes " + (folder_ / "psb") + " -rows whole -points 300 -planes " + (folder_ / "psb") +
                  " -classes " + classes + " -csv " + (folder_ / "f.csv") + arguments),
              0)
        << error_;
    std::string names;
    for (const std::string& row : linesOf(folder_ / "f.csv")) names += row.substr(0, row.find(',')) + " ";
    return names;
  };
  EXPECT_EQ(models(" -fold 0"), "model m4 ");
  EXPECT_EQ(models(" -fold 1"), "model m1 m2 ");
  EXPECT_EQ(models(" -fold 2"), "model m3 ");
  EXPECT_EQ(models(" -fold 0 -folds 2"), "model m3 m4 ");
  EXPECT_EQ(evaluate("-fold 0"), 2) << "needs classes";
  EXPECT_EQ(evaluate("-fold 3 -classes " + classes), 2);
}

TEST_F(EvaluatePlanes, TheSameSeedMakesTheSameClouds) {
  const auto exported = [&](const std::string& name, const std::string& arguments) {
    EXPECT_EQ(evaluate("-no_detect -points 300 -noise 0.01 -num_views 1 -export " + (folder_ / name) + arguments), 0)
        << error_;
    return contentOf(folder_ / (name + "/box_whole_noise_0.01.pcd")) +
           contentOf(folder_ / (name + "/box_scan_0_noise_0.pcd"));
  };
  const std::string first = exported("a", " -seed 3 -max 1");
  EXPECT_GT(first.size(), 1000u);
  EXPECT_EQ(exported("b", " -seed 3 -max 2 -threads 1"), first) << "whatever other models there are";
  EXPECT_NE(exported("c", " -seed 4 -max 1"), first);
}

TEST_F(EvaluatePlanes, LeavesOutWhatItCannotUseAndAnswersBadUsage) {
  folder_.write("meshes/broken.off", "OFF\n3 1 0\n0 0 0\n");
  folder_.write("meshes/point.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
  EXPECT_EQ(evaluate("-no_detect -max 3"), 0) << error_;  // box, broken, point
  EXPECT_EQ(summary()["left_out"].size(), 2u);
  EXPECT_NE(error_.find("broken.off"), std::string::npos);
  EXPECT_EQ(evaluate("-no_detect -first 99"), 1);
  EXPECT_EQ(evaluate("-no_detect -list " + folder_.write("names", "box # the first\nno_such_mesh\n")), 1);
  EXPECT_NE(error_.find("no_such_mesh"), std::string::npos);
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("plans " + meshes_), 2);
  EXPECT_EQ(run("planes"), 2);
  EXPECT_EQ(run("planes " + (folder_ / "nowhere")), 1);
  EXPECT_EQ(run("planes " + meshes_ + " -noise 0,-1"), 2);
  EXPECT_EQ(run("planes " + meshes_ + " -noise 0,x"), 2);
  EXPECT_EQ(run("planes " + meshes_ + " -sweep everything"), 2);
  EXPECT_EQ(run("planes " + meshes_ + " -near_share 0.99"), 2);
  EXPECT_EQ(run("-h"), 0);
  EXPECT_NE(output_.find("planes"), std::string::npos);
  EXPECT_EQ(run("-version"), 0);
  EXPECT_EQ(output_.find("pcl_symmetry_evaluate "), 0u) << output_;
  EXPECT_EQ(run("planes -h"), 0);
  EXPECT_NE(output_.find("pcl_symmetry_evaluate planes psb/train"), std::string::npos);
}

}  // namespace
