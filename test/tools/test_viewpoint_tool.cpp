#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "pictures/raster_image.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

class ViewpointTool : public ToolTest {
protected:
  ViewpointTool() : ToolTest(toolPath("viewpoint")) {}

  const std::string mesh_ = folder_.write("box.off", boxOFF(1.4));
};

TEST_F(ViewpointTool, LooksAtABoxFromACornerAndWorstAlongItsPlanes) {
  const nlohmann::json answer = reportOf(mesh_ + " -quiet");
  const auto best = answer["best"]["direction"].get<std::vector<double>>();
  const auto worst = answer["worst"]["direction"].get<std::vector<double>>();
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(std::abs(best[k]), 0.3);
    largest = std::max(largest, std::abs(worst[k]));
  }
  EXPECT_GT(largest, 0.99);
  EXPECT_GT(answer["best"]["score"].get<double>(), answer["worst"]["score"].get<double>());
  EXPECT_EQ(answer["best"]["pose"].size(), 16u);
  EXPECT_EQ(answer["good"][0], answer["best"]);
  EXPECT_NE(output_.find("worst"), std::string::npos);
}

TEST_F(ViewpointTool, DrawsTheScoreAndTheViews) {
  ASSERT_EQ(run(mesh_ + " -size 120 -png " + (folder_ / "a.png") + " -icon " + (folder_ / "b.png")), 0) << error_;
  EXPECT_EQ(readImage(folder_ / "a.png").width, 360);
  EXPECT_EQ(readImage(folder_ / "b.png").width, 120);
}

}  // namespace
