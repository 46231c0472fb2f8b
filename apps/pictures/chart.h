/// Line charts as PNG files, also on machines without a display.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

struct ChartSeries {
  std::string name;
  std::vector<double> x, y;  ///< as many of one as of the other; values that are not finite are left out
  bool points = true;        ///< marks every value
  bool reference = false;    ///< a thin dashed grey line to compare with
  /// Ends of a band about the series, as many as values, such as those of intervals; empty: there is none.
  std::vector<double> low = {}, high = {};
};

struct ChartAxis {
  std::string title;
  bool logarithmic = false;                             ///< then only values > 0 are drawn
  std::optional<std::pair<double, double>> range = {};  ///< fitted to the series if not set, by decades if logarithmic
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  bool legend_at_bottom_left = false;  ///< or else at the top right
};

/// For several charts under one name: NAME.png and "_what" to NAME_what.png.
std::string chartBeside(const std::string& path, const std::string& what);

/// Draws off screen and writes a PNG whole. Needs a display; tools start one with xvfb-run, see runTool().
/// \throws std::invalid_argument where no series holds a value that can be drawn, InputError if nothing can draw or the
/// file cannot be written.
void writeChart(const Chart& chart, const std::string& path, int width = 1200, int height = 900);

}  // namespace pcl_symmetry::apps
