#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/support/strip_mesh.h"
#include "apps/support/tool_run.h"

namespace {

using nlohmann::json;

/// The tool on two strips of four squares with two segmentations each.
class EvaluateSegmentation : public ToolTest {
protected:
  EvaluateSegmentation() : ToolTest(toolPath("evaluate")) {
    for (const char* name : {"meshes", "people", "people/2", "mine"})
      boost::filesystem::create_directories(folder_ / name);
    folder_.write("meshes/2.off", stripOFF(4));
    folder_.write("meshes/5.off", stripOFF(4));
    folder_.write("people/2/2_0.seg", "0\n0\n1\n1\n");
    folder_.write("people/2/2_1.seg", "0\n0\n0\n0\n");
    folder_.write("people/5_0.seg", "0\n0\n1\n1\n");
    folder_.write("people/5_1.seg", "1\n1\n0\n0\n");
    folder_.write("people/51_1.seg", "1\n");
  }

  int evaluate(const std::string& arguments) {
    return run("segmentation " + (folder_ / "meshes") + " " + (folder_ / "people") + " -json " + json_ + " " +
               arguments);
  }
  json method(std::size_t index) const { return json::parse(contentOf(json_))[index]; }

  const std::string json_ = folder_ / "table.json";
};

TEST_F(EvaluateSegmentation, PeopleAndOneSegment) {
  ASSERT_EQ(evaluate("-methods human,one -categories -csv " + (folder_ / "rows.csv")), 0) << error_;
  EXPECT_EQ(method(0)["method"], "human");
  EXPECT_EQ(method(0)["num_models"], 2);
  EXPECT_NEAR(method(0)["rand"].get<double>(), 0.5 * (4.0 / 6.0 + 0.0), 1e-12) << "4 of 6 pairs, and none";
  EXPECT_EQ(method(0)["rand_by_category"].size(), 1u) << "the numbers 1 to 20 are humans";
  EXPECT_NEAR(method(1)["rand"].get<double>(), 0.5 * (2.0 / 6.0 + 4.0 / 6.0), 1e-12);
  EXPECT_EQ(method(1)["cut_discrepancy"], json()) << "one segment has no cut";
  EXPECT_NE(output_.find("Human"), std::string::npos);
  EXPECT_NE(contentOf(folder_ / "rows.csv").find("one,5,Human"), std::string::npos);
}

TEST_F(EvaluateSegmentation, JudgesFilesAndSelectsByRemainder) {
  folder_.write("mine/5.seg", "4\n4\n9\n9\n");
  ASSERT_EQ(evaluate("-remainders 1 -methods one -segments " + (folder_ / "mine")), 0) << error_;
  EXPECT_EQ(method(1)["method"], "-segments");
  EXPECT_EQ(method(1)["num_models"], 1);
  EXPECT_EQ(method(1)["rand"], 0.0);
}

TEST_F(EvaluateSegmentation, RefusesWhatDoesNotFit) {
  EXPECT_EQ(evaluate("-methods magic"), 2);
  EXPECT_NE(error_.find("magic"), std::string::npos);
  EXPECT_EQ(evaluate("-remainders 3"), 1) << "no number leaves 3";
  folder_.write("people/2/2_1.seg", "0\n0\n0\n");
  EXPECT_EQ(evaluate(""), 1);
  EXPECT_NE(error_.find("2_1.seg"), std::string::npos);
  folder_.write("people/2/2_1.seg", "0\n-1\n0\n1\n");
  EXPECT_EQ(evaluate(""), 1);
  EXPECT_NE(error_.find("segment of face 1 = -1"), std::string::npos) << error_;
}

}  // namespace
