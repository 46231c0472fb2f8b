#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "pictures/drawing.h"
#include "pictures/picture_actors.h"
#include "pictures/vtk_messages.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kMaxSuperSampled = 4096;  // greatest edge of pictures that are drawn at twice their size, pixels
constexpr double kViewAngle = 25.0;     ///< degrees

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
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); i += step) {
      corners.emplace_back(Eigen::Map<const Eigen::Vector3d>(data->GetPoint(i)));
    }
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

int numColumns(int num_panels, int wanted, int width, int height) {
  if (wanted > 0) return std::min(wanted, num_panels);
  int best = 1;
  double best_edge = 0;
  for (int columns = 1; columns <= num_panels; ++columns) {
    const int rows = (num_panels + columns - 1) / columns;
    const double edge = std::min(double(width) / columns, double(height) / rows);
    if (edge > best_edge) {
      best_edge = edge;
      best = columns;
    }
  }
  return best;
}

/// Positions of the panels of a picture, row by row.
struct PanelGrid {
  int columns, rows, panel_width, panel_height;

  PanelGrid(int num_panels, int wanted_columns, int width, int height)
      : columns(numColumns(num_panels, wanted_columns, width, height)),
        rows((num_panels + columns - 1) / columns),
        panel_width(width / columns),
        panel_height(height / rows) {}

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
  if (!messages.firstError().empty()) {
    throw InputError(target.name + ": cannot be drawn, " + messages.firstError().substr(0, 200));
  }
}

}  // namespace pcl_symmetry::apps
