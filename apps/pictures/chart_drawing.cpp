#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotPoints.h>
#include <vtkRect.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include "pictures/colors.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

namespace {

using Color = Eigen::Matrix<unsigned char, 3, 1>;

/// A translucent band between the ends of intervals, without an entry in the legend.
void addBand(vtkChartXY& plots, const ChartSeries& series, const Color& color) {
  vtkNew<vtkFloatArray> x, low, high;
  x->SetName("x");
  low->SetName("low");
  high->SetName("high");
  for (std::size_t i = 0; i < series.low.size(); ++i) {
    x->InsertNextValue(static_cast<float>(series.x[i]));
    low->InsertNextValue(static_cast<float>(series.low[i]));
    high->InsertNextValue(static_cast<float>(series.high[i]));
  }
  if (x->GetNumberOfTuples() == 0) return;
  vtkNew<vtkTable> table;
  table->AddColumn(x);
  table->AddColumn(low);
  table->AddColumn(high);
  auto* band = vtkPlotArea::SafeDownCast(plots.AddPlot(vtkChart::AREA));
  band->SetInputData(table);
  band->SetInputArray(0, "x");
  band->SetInputArray(1, "low");
  band->SetInputArray(2, "high");
  // chosen: four bands over each other let the lines show; at half bands fade, at twice they cover each other.
  constexpr unsigned char kOpacity = 50;
  band->SetColor(color[0], color[1], color[2], kOpacity);
  band->SetLegendVisibility(false);
}

void addSeries(vtkChartXY& plots, const ChartSeries& series, std::size_t index) {
  vtkNew<vtkFloatArray> x, y;
  x->SetName("x");
  y->SetName(series.name.c_str());
  for (std::size_t i = 0; i < series.x.size(); ++i) {
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
  const Color color = (255.0 * distinctColor(index)).cast<unsigned char>();
  plot->SetColor(color[0], color[1], color[2], 255);
  addBand(plots, series, color);
  plot->SetWidth(3.0f);
  if (series.points) {
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerStyle(vtkPlotPoints::CIRCLE);
    vtkPlotPoints::SafeDownCast(plot)->SetMarkerSize(9.0f);
  }
}

void setUp(vtkAxis& drawn, const ChartAxis& axis) {
  drawn.SetTitle(axis.title);
  drawn.GetTitleProperties()->SetFontSize(22);
  drawn.GetLabelProperties()->SetFontSize(18);
  drawn.SetBehavior(vtkAxis::FIXED);
  drawn.SetRange(axis.range->first, axis.range->second);
  drawn.SetLogScale(axis.logarithmic);
}

}  // namespace

void drawChart(const Chart& chart, const PictureTarget& target) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  requireDisplay(target.name);
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(target.width, target.height);
  view->GetRenderWindow()->SetMultiSamples(0);
  view->GetRenderer()->SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkChartXY> plots;
  view->GetScene()->AddItem(plots);
  plots->SetAutoSize(false);
  plots->SetSize(vtkRectf(0, 0, static_cast<float>(target.width - 30),
                          static_cast<float>(target.height)));  // room for the last label
  plots->SetTitle(chart.title);
  plots->GetTitleProperties()->SetFontSize(24);
  plots->SetShowLegend(true);
  plots->GetLegend()->SetLabelSize(18);
  if (chart.legend_at_bottom_left) {
    plots->GetLegend()->SetHorizontalAlignment(vtkChartLegend::LEFT);
    plots->GetLegend()->SetVerticalAlignment(vtkChartLegend::BOTTOM);
  }
  setUp(*plots->GetAxis(vtkAxis::BOTTOM), chart.x);
  setUp(*plots->GetAxis(vtkAxis::LEFT), chart.y);
  for (std::size_t i = 0; i < chart.series.size(); ++i) addSeries(*plots, chart.series[i], i);

  view->GetRenderWindow()->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(view->GetRenderWindow());
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(target.file.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw InputError(target.name + ": cannot be written");
}

}  // namespace pcl_symmetry::apps
