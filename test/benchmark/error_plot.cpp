#include "error_plot.h"

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
#include <cmath>
#include <stdexcept>

#include "private_display.h"

namespace pcl_symmetry::benchmarks {

namespace {

constexpr int kWidth = 1200, kHeight = 900;
constexpr unsigned char kColors[][3] = {{31, 119, 180}, {214, 39, 40}, {44, 160, 44}, {148, 103, 189}};

/// Powers of ten below and above the values.
std::pair<double, double> decades(const std::vector<Series>& series, std::vector<double> Series::*values) {
  double least = 1e300, largest = 0.0;
  for (const Series& s : series) {
    for (const double value : s.*values) {
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
  }
  return {std::pow(10.0, std::floor(std::log10(least))), std::pow(10.0, std::ceil(std::log10(largest)))};
}

vtkPlot* addPlot(vtkChartXY* chart, const Series& s, int type) {
  vtkNew<vtkFloatArray> x, y;
  x->SetName("milliseconds");
  y->SetName(s.name.c_str());
  for (const double value : s.milliseconds) x->InsertNextValue(static_cast<float>(value));
  for (const double value : s.error) y->InsertNextValue(static_cast<float>(value));
  vtkNew<vtkTable> table;
  table->AddColumn(x);
  table->AddColumn(y);
  vtkPlot* plot = chart->AddPlot(type);
  plot->SetInputData(table, 0, 1);
  return plot;
}

void setUpAxis(vtkAxis* axis, const char* title, std::pair<double, double> range) {
  axis->SetTitle(title);
  axis->GetTitleProperties()->SetFontSize(22);
  axis->GetLabelProperties()->SetFontSize(18);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(range.first, range.second);
  axis->SetLogScale(true);
}

}  // namespace

void writeErrorPlot(const std::string& file, const std::vector<Series>& series) {
  const apps::PrivateDisplay display;
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(kWidth, kHeight);
  view->GetRenderWindow()->SetMultiSamples(0);
  view->GetRenderer()->SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkChartXY> chart;
  view->GetScene()->AddItem(chart);
  chart->SetAutoSize(false);
  chart->SetSize(vtkRectf(0, 0, kWidth - 30, kHeight));  // room for the last label
  chart->SetTitle("Error of PRST against time, mean of the models");
  chart->GetTitleProperties()->SetFontSize(24);
  chart->SetShowLegend(true);
  chart->GetLegend()->SetLabelSize(18);
  const auto time_range = decades(series, &Series::milliseconds), error_range = decades(series, &Series::error);
  setUpAxis(chart->GetAxis(vtkAxis::BOTTOM), "time [ms]", time_range);
  setUpAxis(chart->GetAxis(vtkAxis::LEFT), "root mean square error of PRST", error_range);

  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto& color = kColors[i % std::size(kColors)];
    vtkPlot* plot = addPlot(chart, series[i], vtkChart::LINE);
    plot->SetColor(color[0], color[1], color[2], 255);
    plot->SetWidth(3.0f);
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerStyle(vtkPlotPoints::CIRCLE);
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerSize(9.0f);
  }
  vtkPlot* one_per_cent = addPlot(chart, {"1 %", {time_range.first, time_range.second}, {0.01, 0.01}}, vtkChart::LINE);
  one_per_cent->SetColor(120, 120, 120, 255);
  one_per_cent->GetPen()->SetLineType(vtkPen::DASH_LINE);

  view->GetRenderWindow()->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(view->GetRenderWindow());
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace pcl_symmetry::benchmarks
