#include <pcl/conversions.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkLookupTable.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "pictures/drawing.h"
#include "pictures/patch_geometry.h"
#include "pictures/vtk_messages.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kMaxSuperSampled = 4096;  // greatest edge of pictures that are drawn at twice their size, pixels
constexpr double kViewAngle = 25.0;     ///< degrees

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

/// \return brightness of each point with a light at the camera, in [0, 1].
std::vector<double> shading(const PictureScene& scene, const Normalization& normalize) {
  const Points normals = pointNormals(*scene.points, normalize);
  const Eigen::RowVectorXf cosines = (scene.view.normalized().cast<float>().transpose() * normals).cwiseAbs();
  std::vector<double> brightness(scene.points->size(), 1.0);
  for (std::size_t i = 0; i < brightness.size(); ++i)
    if (std::isfinite(cosines[static_cast<Eigen::Index>(i)])) brightness[i] = cosines[static_cast<Eigen::Index>(i)];
  return brightness;
}

/// \param panel_pixels the shorter edge of the panel, pixels.
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
    colors->InsertNextTypedTuple(bytesOf((shade.least + shade.range * brightness[i]) * pointColor(panel, i)).data());
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

/// The mesh in light gray; in the colors of the panel's segments, or of its support if it shows no points and has one
/// value per vertex.
vtkSmartPointer<vtkActor> meshActor(const pcl::PolygonMesh& mesh, const PicturePanel& panel,
                                    const Normalization& normalize) {
  Cloud vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  vtkNew<vtkPoints> points;
  for (const pcl::PointXYZ& vertex : vertices)
    points->InsertNextPoint(normalize(vertex.getVector3fMap().cast<double>()).data());
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
    if (!panel.segments.empty()) colors->InsertNextTypedTuple(bytesOf(segmentColor(panel.segments[f])).data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  if (!panel.segments.empty()) data->GetCellData()->SetScalars(colors);
  const bool colored = !panel.show_points && panel.support.size() == vertices.size();
  if (colored) {
    vtkNew<vtkUnsignedCharArray> shades;
    shades->SetNumberOfComponents(3);
    for (const double value : panel.support) shades->InsertNextTypedTuple(bytesOf(cividis(value)).data());
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

/// Names of the panel's segments on their colors, in the lower left corner.
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

/// Places the camera so that all of the panel lies inside the picture, below the label and left of the color bar.
/// \param bar_share share of the panel's width that the color bar takes.
void fitCamera(vtkRenderer& renderer, const PictureScene& scene, double aspect, double bar_share) {
  vtkCamera* camera = renderer.GetActiveCamera();
  const Eigen::Vector3d view = scene.view.normalized(), up = scene.up.normalized();
  camera->SetFocalPoint(0, 0, 0);
  camera->SetPosition(view.x(), view.y(), view.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetViewAngle(kViewAngle);
  const Eigen::Vector3d right = up.cross(view).normalized(), top = view.cross(right);
  const double half_height = std::tan(kViewAngle / 2 * kPi / 180) * 0.88,
               half_width = half_height * aspect * (1 - bar_share);

  double distance = 0;
  vtkActorCollection* actors = renderer.GetActors();
  actors->InitTraversal();
  std::vector<Eigen::Vector3d> corners;
  while (vtkActor* actor = actors->GetNextActor()) {
    vtkPolyData* data = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput());
    const vtkIdType step = std::max<vtkIdType>(1, data->GetNumberOfPoints() / 20000);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); i += step)
      corners.emplace_back(Eigen::Map<const Eigen::Vector3d>(data->GetPoint(i)));
  }
  Eigen::AlignedBox2d window;
  for (const Eigen::Vector3d& corner : corners) window.extend(Eigen::Vector2d(right.dot(corner), top.dot(corner)));
  const Eigen::Vector2d middle = window.center();
  for (const Eigen::Vector3d& corner : corners) {
    const double x = std::abs(right.dot(corner) - middle.x()), y = std::abs(top.dot(corner) - middle.y());
    distance = std::max(distance, view.dot(corner) + std::max(x / half_width, y / half_height));
  }
  const double shift = bar_share * half_height * aspect * distance;
  const Eigen::Vector3d focus = (middle.x() + shift) * right + (middle.y() + 0.05 * half_height * distance) * top;
  const Eigen::Vector3d position = focus + std::max(distance, 1e-3) * view;
  camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
  camera->SetPosition(position.x(), position.y(), position.z());
  renderer.ResetCameraClippingRange();
}

/// Positions of the panels of a picture, row by row.
struct PanelGrid {
  int columns = 1, rows, panel_width, panel_height;

  /// \param wanted_columns 0 = those that make the panels largest.
  PanelGrid(int num_panels, int wanted_columns, int width, int height) {
    double best_edge = 0;
    for (int k = 1; k <= num_panels; ++k) {
      const double edge = std::min(double(width) / k, double(height) / ((num_panels + k - 1) / k));
      if (edge > best_edge) columns = k;
      best_edge = std::max(best_edge, edge);
    }
    if (wanted_columns > 0) columns = std::min(wanted_columns, num_panels);
    rows = (num_panels + columns - 1) / columns;
    panel_width = width / columns;
    panel_height = height / rows;
  }

  void place(vtkRenderer& renderer, int panel) const {
    const int column = panel % columns, row = panel / columns;
    renderer.SetViewport(double(column) / columns, 1.0 - double(row + 1) / rows, double(column + 1) / columns,
                         1.0 - double(row) / rows);
  }
};

/// \param first_panel index of the scene's first panel among the panels of the picture.
void addPanels(vtkRenderWindow& window, const PictureScene& scene, const PanelGrid& grid, int first_panel) {
  const double panel_pixels = std::min(grid.panel_width, grid.panel_height);
  const int font_size = std::max(8, static_cast<int>(std::lround(panel_pixels * 0.036)));
  const Normalization normalize = normalizationOf(scene);
  const std::vector<double> brightness = shading(scene, normalize);
  for (std::size_t i = 0; i < scene.panels.size(); ++i) {
    const PicturePanel& panel = scene.panels[i];
    vtkNew<vtkRenderer> renderer;
    grid.place(*renderer, first_panel + static_cast<int>(i));
    renderer->SetBackground(1, 1, 1);
    renderer->SetUseDepthPeeling(true);
    renderer->SetMaximumNumberOfPeels(16);
    renderer->SetOcclusionRatio(0.0);
    if (scene.mesh) renderer->AddActor(meshActor(*scene.mesh, panel, normalize));
    if (panel.show_points && (!scene.mesh || panel.segments.empty()))
      renderer->AddActor(cloudActor(scene, panel, normalize, brightness, panel_pixels));
    for (const AxisLine& axis : panel.axes) addAxis(*renderer, axis, scene, normalize, panel_pixels / 120);
    for (const PlanePatch& plane : panel.planes) addPlane(*renderer, plane, scene, normalize, panel_pixels / 250);
    const bool has_bar = scene.show_color_bar && !panel.support.empty();
    fitCamera(*renderer, scene, double(grid.panel_width) / grid.panel_height, has_bar ? 0.12 : 0.0);
    if (!panel.label.empty()) {
      // Widest letters of Arial.
      const double widest = 1.75 * grid.panel_width / static_cast<double>(panel.label.size());
      renderer->AddActor2D(labelActor(panel.label, std::min(font_size, static_cast<int>(widest))));
    }
    const int small_font = std::max(8, font_size * 3 / 4);
    addLegend(*renderer, panel, grid.panel_height, small_font);
    if (has_bar) renderer->AddActor2D(colorBar(grid.panel_width, grid.panel_height, small_font));
    window.AddRenderer(renderer);
  }
}

}  // namespace

void drawScenes(const std::vector<PictureScene>& scenes, const PictureTarget& target, int num_columns) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  int num_panels = 0;
  for (const PictureScene& scene : scenes) num_panels += static_cast<int>(scene.panels.size());
  requireDisplay(target.name);
  const VtkMessages messages;
  const int factor = std::max(target.width, target.height) <= kMaxSuperSampled ? 2 : 1;
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(factor * target.width, factor * target.height);
  const PanelGrid grid(num_panels, num_columns, factor * target.width, factor * target.height);
  int next_panel = 0;
  for (const PictureScene& scene : scenes) {
    addPanels(*window, scene, grid, next_panel);
    next_panel += static_cast<int>(scene.panels.size());
  }
  for (; next_panel < grid.columns * grid.rows; ++next_panel) {
    vtkNew<vtkRenderer> blank;
    grid.place(*blank, next_panel);
    blank->SetBackground(1, 1, 1);
    window->AddRenderer(blank);
  }
  if (!window->SupportsOpenGL()) throw InputError(target.name + ": cannot be drawn, the display has no OpenGL 3.2");
  window->Render();

  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  vtkNew<vtkImageShrink3D> shrink;
  shrink->SetInputConnection(grab->GetOutputPort());
  shrink->SetShrinkFactors(factor, factor, 1);
  shrink->AveragingOn();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(shrink->GetOutputPort());
  writer->SetFileName(target.file.c_str());
  writer->Write();
  window->Finalize();
  if (!messages.firstError().empty())
    throw InputError(target.name + ": cannot be drawn, " + messages.firstError().substr(0, 200));
}

}  // namespace pcl_symmetry::apps
