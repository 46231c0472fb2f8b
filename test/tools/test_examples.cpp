#include <gtest/gtest.h>

#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

/// The examples, run on a scan of a box, on a whole box, and on the box on a table.
class Examples : public ToolTest {
protected:
  Examples() : ToolTest("env PATH=" EXAMPLES) {}

  void SetUp() override {
    const std::string mesh = folder_.write("box.off", boxOFF(1.4));
    const std::string table = folder_.write(
        "scene.off",
        "OFF\n12 7 0\n-1 -1.4 -2\n1 -1.4 -2\n1 1.4 -2\n-1 1.4 -2\n-1 -1.4 2\n1 -1.4 2\n1 1.4 2\n-1 1.4 2\n"
        "-6 -6 -2\n6 -6 -2\n6 6 -2\n-6 6 -2\n"
        "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n4 8 9 10 11\n");
    for (const std::string& command : {SCAN_TOOL " " + mesh + " " + scan_,
                                       SCAN_TOOL " " + table + " " + (folder_ / "scene.pcd") + " -direction 1,1.5,1",
                                       PLANES_TOOL " " + mesh + " -support " + box_})
      ASSERT_EQ(std::system((command + " -quiet >" + (folder_ / "ignored")).c_str()), 0);
  }

  const std::string scan_ = folder_ / "scan.pcd", box_ = folder_ / "box.pcd", out_ = folder_ / "out.pcd";
};

int numOf(const std::string& part, const std::string& text) {
  int num = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++num;
  return num;
}

TEST_F(Examples, PrintWhatTheyFind) {
  struct Example {
    std::string command;
    std::vector<std::string> printed = {};  // at least once
    std::pair<const char*, int> counted = {"", 0};
    const char* written = "";  // at the start of the output file
  };
  const Example examples[] = {{"01_first_plane " + box_, {"a b c d = ", "reflects to"}},
                              {"02_options " + box_, {"262144 planes"}, {"symmetry ", 3}},
                              {"03_visibility " + scan_, {"seen from one side", "have a counterpart"}},
                              {"04_alignment " + scan_, {"center of symmetry"}, {"axis", 3}},
                              {"05_registration " + scan_ + " " + box_, {"merit"}},
                              {"06_matching " + (folder_ / "models") + " " + scan_ + " " + box_,
                               {"PRST ", "model_1 distance", "model_1 confidence "}},
                              {"07_segmentation " + box_ + " " + out_, {"part 0: "}, {}, "FIELDS x y z label"},
                              {"08_own_search_and_point_type " + box_, {}, {"confidence", 3}},
                              // The box of D2 turns by 0.1 radians a frame.
                              {"09_symmetric_poses " + box_, {"group D2", "look 28.6"}, {"the track by 5.7", 5}},
                              {"10_scene " + (folder_ / "scene.pcd") + " " + out_,
                               {"1 supporting planes", "  plane "},
                               {"object of ", 1},
                               "FIELDS x y z"},
                              {"11_completion " + scan_ + " " + out_, {" points added to "}, {}, "FIELDS x y z"},
                              {"12_viewpoint " + box_, {"seen from ", "worst "}}};
  for (const Example& example : examples) {
    SCOPED_TRACE(example.command);
    ASSERT_EQ(run(example.command), 0) << error_;
    for (const std::string& part : example.printed) EXPECT_GE(numOf(part, output_), 1) << part << " in\n" << output_;
    if (example.counted.second > 0) {
      EXPECT_EQ(numOf(example.counted.first, output_), example.counted.second) << output_;
    }
    EXPECT_NE(contentOf(out_).find(example.written), std::string::npos);
  }
}

}  // namespace
