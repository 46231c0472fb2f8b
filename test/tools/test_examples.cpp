#include <gtest/gtest.h>

#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

/// An example run on a scan of a box, or on a whole box.
class Example : public ToolTest {
protected:
  Example() : ToolTest("env PATH=" EXAMPLES) {}

  void SetUp() override {
    const std::string mesh = folder_.write("box.off", boxOFF(1.4));
    const std::string quiet = " -quiet >" + (folder_ / "ignored");
    ASSERT_EQ(std::system((SCAN_TOOL " " + mesh + " " + (folder_ / "scan.pcd") + quiet).c_str()), 0);
    ASSERT_EQ(std::system((PLANES_TOOL " " + mesh + " -support " + (folder_ / "box.pcd") + quiet).c_str()), 0);
  }

  int runOn(const std::string& example, const std::string& cloud) { return run(example + " " + (folder_ / cloud)); }
};

int numLinesWith(const std::string& text, const std::string& part) {
  int num = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++num;
  return num;
}

TEST_F(Example, FirstPlane) {
  ASSERT_EQ(runOn("01_first_plane", "box.pcd"), 0) << error_;
  EXPECT_NE(output_.find("a b c d = "), std::string::npos);
  EXPECT_NE(output_.find("reflects to"), std::string::npos);
}

TEST_F(Example, Options) {
  ASSERT_EQ(runOn("02_options", "box.pcd"), 0) << error_;
  EXPECT_EQ(numLinesWith(output_, "symmetry "), 3) << output_;
  EXPECT_NE(output_.find("262144 planes"), std::string::npos);
}

TEST_F(Example, Visibility) {
  ASSERT_EQ(runOn("03_visibility", "scan.pcd"), 0) << error_;
  EXPECT_NE(output_.find("seen from one side"), std::string::npos) << output_;
  EXPECT_NE(output_.find("have a counterpart"), std::string::npos);
}

TEST_F(Example, Alignment) {
  ASSERT_EQ(runOn("04_alignment", "scan.pcd"), 0) << error_;
  EXPECT_NE(output_.find("center of symmetry"), std::string::npos) << output_;
  EXPECT_EQ(numLinesWith(output_, "axis"), 3);
}

TEST_F(Example, Registration) {
  ASSERT_EQ(run("05_registration " + (folder_ / "scan.pcd") + " " + (folder_ / "box.pcd")), 0) << error_;
  EXPECT_NE(output_.find("merit"), std::string::npos) << output_;
}

TEST_F(Example, Matching) {
  const std::string box = folder_ / "box.pcd";
  ASSERT_EQ(run("06_matching " + (folder_ / "models") + " " + (folder_ / "scan.pcd") + " " + box), 0) << error_;
  EXPECT_NE(output_.find("PRST "), std::string::npos) << output_;
  EXPECT_NE(output_.find("model_1 distance"), std::string::npos) << output_;
  EXPECT_NE(output_.find("model_1 confidence "), std::string::npos) << output_;
}

TEST_F(Example, Segmentation) {
  ASSERT_EQ(run("07_segmentation " + (folder_ / "box.pcd") + " " + (folder_ / "parts.pcd")), 0) << error_;
  EXPECT_NE(output_.find("part 0: "), std::string::npos) << output_;
  EXPECT_NE(contentOf(folder_ / "parts.pcd").find("FIELDS x y z label"), std::string::npos);
}

TEST_F(Example, OwnSearchAndPointType) {
  ASSERT_EQ(runOn("08_own_search_and_point_type", "box.pcd"), 0) << error_;
  EXPECT_EQ(numLinesWith(output_, "confidence"), 3) << output_;
}

/// The box of D2 turns by 0.1 radians a frame.
TEST_F(Example, SymmetricPoses) {
  ASSERT_EQ(runOn("09_symmetric_poses", "box.pcd"), 0) << error_;
  EXPECT_NE(output_.find("group D2"), std::string::npos) << output_;
  EXPECT_EQ(numLinesWith(output_, "the track by 5.7"), 5) << output_;
  EXPECT_NE(output_.find("look 28.6"), std::string::npos) << output_;
}

/// The box on a table.
TEST_F(Example, Scene) {
  const std::string mesh =
      folder_.write("scene.off",
                    "OFF\n12 7 0\n-1 -1.4 -2\n1 -1.4 -2\n1 1.4 -2\n-1 1.4 -2\n-1 -1.4 2\n1 -1.4 2\n1 1.4 2\n-1 1.4 2\n"
                    "-6 -6 -2\n6 -6 -2\n6 6 -2\n-6 6 -2\n"
                    "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n4 8 9 10 11\n");
  const std::string scan = folder_ / "scene.pcd", completed = folder_ / "completed.pcd";
  ASSERT_EQ(
      std::system((SCAN_TOOL " " + mesh + " " + scan + " -direction 1,1.5,1 -quiet >" + (folder_ / "ignored")).c_str()),
      0);
  ASSERT_EQ(run("10_scene " + scan + " " + completed), 0) << error_;
  EXPECT_NE(output_.find("1 supporting planes"), std::string::npos) << output_;
  EXPECT_EQ(numLinesWith(output_, "object of "), 1) << output_;
  EXPECT_GE(numLinesWith(output_, "  plane "), 1) << output_;
  EXPECT_NE(contentOf(completed).find("FIELDS x y z"), std::string::npos);
}

TEST_F(Example, Completion) {
  const std::string completed = folder_ / "completed.pcd";
  ASSERT_EQ(run("11_completion " + (folder_ / "scan.pcd") + " " + completed), 0) << error_;
  EXPECT_NE(output_.find(" points added to "), std::string::npos) << output_;
  EXPECT_NE(contentOf(completed).find("FIELDS x y z"), std::string::npos);
}

TEST_F(Example, Viewpoint) {
  ASSERT_EQ(runOn("12_viewpoint", "box.pcd"), 0) << error_;
  EXPECT_NE(output_.find("seen from "), std::string::npos) << output_;
  EXPECT_NE(output_.find("worst "), std::string::npos) << output_;
}

}  // namespace
