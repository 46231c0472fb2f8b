#include "pictures/chart.h"

#include <algorithm>
#include <boost/filesystem/path.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "pictures/drawing.h"
#include "io/load_module.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

bool drawable(const ChartAxis& axis, double value) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0.0);
}

bool drawable(const Chart& chart, const ChartSeries& series, std::size_t i) {
  return drawable(chart.x, series.x[i]) && drawable(chart.y, series.y[i]);
}

std::pair<double, double> rangeOf(const Chart& chart, const ChartAxis& axis, std::vector<double> ChartSeries::*values) {
  if (axis.range) return *axis.range;
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const ChartSeries& series : chart.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (series.reference || !drawable(chart, series, i)) continue;
      least = std::min(least, (series.*values)[i]);
      largest = std::max(largest, (series.*values)[i]);
    }
  }
  if (!(least <= largest)) throw std::invalid_argument("chart: no series holds a value that can be drawn");
  if (axis.logarithmic)
    return {std::pow(10.0, std::floor(std::log10(least))), std::pow(10.0, std::ceil(std::log10(largest)))};
  return least < largest ? std::make_pair(least, largest) : std::make_pair(least - 0.5, largest + 0.5);
}

/// \return the chart with both ranges set and without the values that cannot be drawn.
Chart readyToDraw(Chart chart) {
  const auto x_range = rangeOf(chart, chart.x, &ChartSeries::x), y_range = rangeOf(chart, chart.y, &ChartSeries::y);
  for (ChartSeries& series : chart.series) {
    ChartSeries drawn = series;
    const bool banded = !series.low.empty();
    drawn.x.clear();
    drawn.y.clear();
    drawn.low.clear();
    drawn.high.clear();
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!drawable(chart, series, i)) continue;
      drawn.x.push_back(series.x[i]);
      drawn.y.push_back(series.y[i]);
      if (!banded) continue;
      drawn.low.push_back(series.low[i]);
      drawn.high.push_back(series.high[i]);
    }
    series = std::move(drawn);
  }
  chart.x.range = x_range;
  chart.y.range = y_range;
  return chart;
}

}  // namespace

std::string chartBeside(const std::string& path, const std::string& what) {
  const boost::filesystem::path file(path);
  return (file.parent_path() / (file.stem().string() + what + ".png")).string();
}

void writeChart(const Chart& chart, const std::string& path, int width, int height) {
  for (const ChartSeries& series : chart.series) {
    if (series.x.size() != series.y.size()) {
      throw std::invalid_argument("chart: series '" + series.name + "' holds " + std::to_string(series.x.size()) +
                                  " values of x and " + std::to_string(series.y.size()) + " of y, must be as many");
    }
    const bool banded = !series.low.empty() || !series.high.empty();
    if (banded && (series.low.size() != series.y.size() || series.high.size() != series.y.size()))
      throw std::invalid_argument("chart: series '" + series.name + "' has a band of other length");
  }
  writeAtomically(path, [&](const std::string& temporary) {
    functionOf<decltype(drawChart)>(kDrawingModule, "drawChart")(readyToDraw(chart), {path, temporary, width, height});
  });
}

}  // namespace pcl_symmetry::apps
