#include "pictures/picture_actors.h"

#include <pcl/conversions.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "pictures/patch_geometry.h"

namespace pcl_symmetry::apps {

namespace {

void addColor(vtkUnsignedCharArray& colors, const Eigen::Vector3d& color) {
  for (int k = 0; k < 3; ++k)
    colors.InsertNextValue(static_cast<unsigned char>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
}

/// Adds data in one color and without light.
/// \return how it is drawn.
vtkSmartPointer<vtkPolyDataMapper> addPlain(vtkRenderer& renderer, vtkPolyData* data, const Eigen::Vector3d& color,
                                            double line_width, double opacity = 1.0) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color.x(), color.y(), color.z());
  actor->GetProperty()->SetOpacity(opacity);
  actor->GetProperty()->SetLineWidth(static_cast<float>(line_width));
  actor->GetProperty()->LightingOff();
  renderer.AddActor(actor);
  return mapper;
}

}  // namespace

std::vector<double> shading(const PictureScene& scene, const Normalization& normalize) {
  const Points normals = pointNormals(*scene.points, normalize);
  const Eigen::RowVectorXf cosines = (scene.view.normalized().cast<float>().transpose() * normals).cwiseAbs();
  std::vector<double> brightness(scene.points->size(), 1.0);
  for (std::size_t i = 0; i < brightness.size(); ++i)
    if (std::isfinite(cosines[static_cast<Eigen::Index>(i)])) brightness[i] = cosines[static_cast<Eigen::Index>(i)];
  return brightness;
}

vtkSmartPointer<vtkActor> cloudActor(const PictureScene& scene, const PicturePanel& panel,
                                     const Normalization& normalize, const std::vector<double>& brightness,
                                     double panel_pixels) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < scene.points->size(); ++i) {
    const Eigen::Vector3d position = (*scene.points)[i].getVector3fMap().cast<double>();
    if (!position.allFinite()) continue;
    const vtkIdType id = points->InsertNextPoint(normalize(position).data());
    cells->InsertNextCell(1, &id);
    const PointShade shade = shadeOf(!panel.support.empty() || !panel.segments.empty());
    addColor(*colors, (shade.least + shade.range * brightness[i]) * pointColor(panel, i));
  }
  const double num_points = static_cast<double>(points->GetNumberOfPoints());
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  data->GetPointData()->SetScalars(colors);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetPointSize(
      static_cast<float>(std::clamp(0.9 * panel_pixels / std::sqrt(num_points), 1.5, panel_pixels / 60)));
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkSmartPointer<vtkActor> meshActor(const pcl::PolygonMesh& mesh, const PicturePanel& panel,
                                    const Normalization& normalize) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  vtkNew<vtkPoints> points;
  for (const pcl::PointXYZ& vertex : vertices) {
    points->InsertNextPoint(normalize(vertex.getVector3fMap().cast<double>()).data());
  }
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const pcl::Vertices& polygon = mesh.polygons[f];
    const bool drawable = std::all_of(polygon.vertices.begin(), polygon.vertices.end(), [&](pcl::index_t corner) {
      return corner >= 0 && static_cast<std::size_t>(corner) < vertices.size() &&
             vertices[static_cast<std::size_t>(corner)].getVector3fMap().allFinite();
    });
    if (!drawable) continue;
    cells->InsertNextCell(static_cast<vtkIdType>(polygon.vertices.size()));
    for (const pcl::index_t corner : polygon.vertices) cells->InsertCellPoint(corner);
    if (!panel.segments.empty()) addColor(*colors, segmentColor(panel.segments[f]));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  if (!panel.segments.empty()) data->GetCellData()->SetScalars(colors);
  const bool colored = !panel.show_points && panel.support.size() == vertices.size();
  if (colored) {
    vtkNew<vtkUnsignedCharArray> shades;
    shades->SetNumberOfComponents(3);
    for (const double value : panel.support) addColor(*shades, cividis(value));
    data->GetPointData()->SetScalars(shades);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2.0, 2.0);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(kPlainMeshColor.x(), kPlainMeshColor.y(), kPlainMeshColor.z());
  actor->GetProperty()->SetAmbient(0.25);
  actor->GetProperty()->SetDiffuse(0.75);
  if (!colored) actor->GetProperty()->SetInterpolationToFlat();
  return actor;
}

void addAxis(vtkRenderer& renderer, const AxisLine& axis, const PictureScene& scene, const Normalization& normalize,
             double line_width) {
  const auto [begin, end] = axisEnds(axis, scene);
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(normalize(begin).data());
  points->InsertNextPoint(normalize(end).data());
  const vtkIdType ends[] = {0, 1};
  vtkNew<vtkCellArray> line;
  line->InsertNextCell(2, ends);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(line);
  const auto mapper = addPlain(renderer, data, axis.color, line_width);
  if (!(axis.half_length > 0.0)) return;
  constexpr double kInFront = -66'000.0;  // steps of the depth buffer
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, kInFront);
}

void addPlane(vtkRenderer& renderer, const PlanePatch& plane, const PictureScene& scene, const Normalization& normalize,
              double line_width) {
  vtkNew<vtkPoints> points;
  const auto corners = patchCorners(plane, scene);
  for (const Eigen::Vector3d& corner : corners) points->InsertNextPoint(normalize(corner).data());
  const vtkIdType loop[] = {0, 1, 2, 3, 0};
  vtkNew<vtkCellArray> quad, outline;
  quad->InsertNextCell(4, loop);
  outline->InsertNextCell(5, loop);
  vtkNew<vtkPolyData> filled, border;
  filled->SetPoints(points);
  filled->SetPolys(quad);
  addPlain(renderer, filled, plane.color, line_width, 0.25);
  border->SetPoints(points);
  border->SetLines(outline);
  addPlain(renderer, border, plane.color, line_width);
}

vtkSmartPointer<vtkTextActor> labelActor(const std::string& text, int font_size) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->GetTextProperty()->SetFontFamilyToArial();
  actor->GetTextProperty()->SetFontSize(font_size);
  actor->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
  actor->GetTextProperty()->SetJustificationToCentered();
  actor->GetTextProperty()->SetVerticalJustificationToTop();
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->GetPositionCoordinate()->SetValue(0.5, 0.98);
  return actor;
}

void addLegend(vtkRenderer& renderer, const PicturePanel& panel, int panel_height, int font_size) {
  constexpr std::size_t kMostNames = 16;
  const std::size_t number = std::min(panel.legend.size(), kMostNames);
  for (std::size_t i = 0; i < number; ++i) {
    const auto& [segment, own_name] = panel.legend[i];
    const bool is_last = i + 1 == number && number < panel.legend.size();
    const std::string name = is_last ? "... " + std::to_string(panel.legend.size()) + " in all" : own_name;
    const Eigen::Vector3d color = segmentColor(segment);
    const double ink = color.mean() < 0.45 ? 1.0 : 0.1;
    vtkNew<vtkTextActor> actor;
    actor->SetInput((" " + name + " ").c_str());
    actor->GetTextProperty()->SetFontFamilyToArial();
    actor->GetTextProperty()->SetFontSize(font_size);
    actor->GetTextProperty()->SetColor(ink, ink, ink);
    actor->GetTextProperty()->SetBackgroundColor(color.x(), color.y(), color.z());
    actor->GetTextProperty()->SetBackgroundOpacity(1.0);
    actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    actor->GetPositionCoordinate()->SetValue(0.02, 0.02 + 1.6 * font_size * (number - 1 - i) / panel_height);
    renderer.AddActor2D(actor);
  }
}

vtkSmartPointer<vtkScalarBarActor> colorBar(int panel_width, int panel_height, int font_size) {
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(128);
  table->SetTableRange(0, 1);
  for (int i = 0; i < 128; ++i) {
    const Eigen::Vector3d color = cividis(i / 127.0);
    table->SetTableValue(i, color.x(), color.y(), color.z(), 1);
  }
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(table);
  bar->SetTitle("support");
  bar->SetNumberOfLabels(3);
  bar->SetLabelFormat(" %.1f");
  bar->UnconstrainedFontSizeOn();
  for (vtkTextProperty* text : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    text->SetFontFamilyToArial();
    text->SetFontSize(font_size);
    text->SetColor(0.1, 0.1, 0.1);
    text->BoldOff();
    text->ItalicOff();
    text->ShadowOff();
  }
  const double height = 0.28, width = std::min(0.25, 4.5 * font_size / panel_width);
  bar->SetMaximumHeightInPixels(static_cast<int>(height * panel_height));
  bar->SetMaximumWidthInPixels(static_cast<int>(width * panel_width));
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  bar->SetPosition(0.98 - width, 0.03);
  bar->SetWidth(width);
  bar->SetHeight(height);
  return bar;
}

}  // namespace pcl_symmetry::apps
