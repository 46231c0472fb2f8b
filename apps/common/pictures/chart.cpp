#include "common/pictures/chart.h"

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRect.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <boost/filesystem/path.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/pictures/picture.h"
#include "common/pictures/private_display.h"
#include "common/shape_output/shape_output.h"

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

void addSeries(vtkChartXY& plots, const Chart& chart, const ChartSeries& series, std::size_t index) {
  vtkNew<vtkFloatArray> x, y;
  x->SetName("x");
  y->SetName(series.name.c_str());
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(chart, series, i)) continue;
    x->InsertNextValue(static_cast<float>(series.x[i]));
    y->InsertNextValue(static_cast<float>(series.y[i]));
  }
  if (x->GetNumberOfTuples() == 0) return;
  vtkNew<vtkTable> table;
  table->AddColumn(x);
  table->AddColumn(y);
  vtkPlot* plot = plots.AddPlot(vtkChart::LINE);
  plot->SetInputData(table, 0, 1);
  if (series.reference) {
    plot->SetColor(120, 120, 120, 255);
    plot->GetPen()->SetLineType(vtkPen::DASH_LINE);
    return;
  }
  const Eigen::Vector3d color = 255.0 * distinctColor(index);
  plot->SetColor(static_cast<unsigned char>(color[0]), static_cast<unsigned char>(color[1]),
                 static_cast<unsigned char>(color[2]), 255);
  plot->SetWidth(3.0f);
  if (series.points) {
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerStyle(vtkPlotPoints::CIRCLE);
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerSize(9.0f);
  }
}

void setUp(vtkAxis& drawn, const ChartAxis& axis, std::pair<double, double> range) {
  drawn.SetTitle(axis.title);
  drawn.GetTitleProperties()->SetFontSize(22);
  drawn.GetLabelProperties()->SetFontSize(18);
  drawn.SetBehavior(vtkAxis::FIXED);
  drawn.SetRange(range.first, range.second);
  drawn.SetLogScale(axis.logarithmic);
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
  }
  const auto x_range = rangeOf(chart, chart.x, &ChartSeries::x), y_range = rangeOf(chart, chart.y, &ChartSeries::y);
  const PrivateDisplay display;
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(width, height);
  view->GetRenderWindow()->SetMultiSamples(0);
  view->GetRenderer()->SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkChartXY> plots;
  view->GetScene()->AddItem(plots);
  plots->SetAutoSize(false);
  plots->SetSize(
      vtkRectf(0, 0, static_cast<float>(width - 30), static_cast<float>(height)));  // room for the last label
  plots->SetTitle(chart.title);
  plots->GetTitleProperties()->SetFontSize(24);
  plots->SetShowLegend(true);
  plots->GetLegend()->SetLabelSize(18);
  if (chart.legend_at_bottom_left) {
    plots->GetLegend()->SetHorizontalAlignment(vtkChartLegend::LEFT);
    plots->GetLegend()->SetVerticalAlignment(vtkChartLegend::BOTTOM);
  }
  setUp(*plots->GetAxis(vtkAxis::BOTTOM), chart.x, x_range);
  setUp(*plots->GetAxis(vtkAxis::LEFT), chart.y, y_range);
  for (std::size_t i = 0; i < chart.series.size(); ++i) addSeries(*plots, chart, chart.series[i], i);

  view->GetRenderWindow()->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(view->GetRenderWindow());
  writeAtomically(path, [&](const std::string& temporary_path) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(temporary_path.c_str());
    writer->SetInputConnection(image->GetOutputPort());
    writer->Write();
    if (writer->GetErrorCode() != 0) throw InputError(path + ": cannot be written");
  });
}

}  // namespace pcl_symmetry::apps
