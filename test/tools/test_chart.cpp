#include <gtest/gtest.h>

#include <limits>

#include "tools/display.h"
#include "tools/temporary_folder.h"
#include "pictures/chart.h"

namespace {

using namespace pcl_symmetry::apps;

Chart twoSeries() {
  Chart chart;
  chart.title = "rates";
  chart.x.title = "x";
  chart.y.title = "y";
  chart.series = {{"a", {1.0, 2.0, 3.0}, {0.1, std::numeric_limits<double>::quiet_NaN(), 0.3}},
                  {"b", {1.0, 2.0, 3.0}, {0.5, 0.4, 0.2}}};
  return chart;
}

class Charts : public testing::Test {
protected:
  static void SetUpTestSuite() { findDisplayForTest(); }
};

TEST_F(Charts, IsAWholePNG) {
  const TemporaryFolder folder;
  writeChart(twoSeries(), folder / "a.png", 400, 300);
  const std::string png = contentOf(folder / "a.png");
  ASSERT_GT(png.size(), 2000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST_F(Charts, DrawsWhatItsSeriesHold) {
  const TemporaryFolder folder;
  Chart chart = twoSeries();
  writeChart(chart, folder / "a.png", 400, 300);
  chart.series[1].y = {0.2, 0.4, 0.5};
  writeChart(chart, folder / "b.png", 400, 300);
  EXPECT_NE(contentOf(folder / "a.png"), contentOf(folder / "b.png"));
  ChartSeries& banded = chart.series[1];
  for (const double y : banded.y) {
    banded.low.push_back(y - 0.1);
    banded.high.push_back(y + 0.1);
  }
  writeChart(chart, folder / "c.png", 400, 300);
  EXPECT_NE(contentOf(folder / "b.png"), contentOf(folder / "c.png")) << "the band";
  banded.high.pop_back();
  EXPECT_THROW(writeChart(chart, folder / "d.png"), std::invalid_argument);
}

TEST_F(Charts, RefusesWhatItCannotDraw) {
  const TemporaryFolder folder;
  Chart uneven = twoSeries();
  uneven.series[0].y.pop_back();
  EXPECT_THROW(writeChart(uneven, folder / "a.png"), std::invalid_argument);
  Chart negative = twoSeries();
  negative.y.logarithmic = true;
  for (ChartSeries& series : negative.series) series.y = {-1.0, -1.0, 0.0};
  EXPECT_THROW(writeChart(negative, folder / "a.png"), std::invalid_argument);
  EXPECT_THROW(writeChart(twoSeries(), folder / "nowhere/a.png", 400, 300), InputError);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
