#include "common/pictures/picture.h"

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPNGWriter.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "common/pictures/picture_actors.h"
#include "common/pictures/private_display.h"
#include "common/shape_output/shape_output.h"
#include "core/base/constants.h"

namespace pcl_symmetry::apps {

namespace {

/// Pictures up to this edge, pixels, are drawn at twice their size. chosen: half leaves steps in large pictures, twice
/// is more than the graphics memory of small machines.
constexpr int kMaxSuperSampled = 4096;
constexpr double kViewAngle = 25.0;  ///< degrees; chosen: half looks flat, twice distorts the edges

/// Keeps VTK's messages for the one line that reports a failure.
class MessageCollector : public vtkOutputWindow {
public:
  static MessageCollector* New();
  vtkTypeMacro(MessageCollector, vtkOutputWindow);
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error.empty() && text) first_error = text;
  }
  std::string first_error;
};
vtkStandardNewMacro(MessageCollector);

/// Puts the collector in place of VTK's own window while a picture is made.
class CollectedMessages {
public:
  CollectedMessages() : old_(vtkOutputWindow::GetInstance()) { vtkOutputWindow::SetInstance(collector_); }
  ~CollectedMessages() { vtkOutputWindow::SetInstance(old_); }
  CollectedMessages(const CollectedMessages&) = delete;
  CollectedMessages& operator=(const CollectedMessages&) = delete;
  const std::string& firstError() const { return collector_->first_error; }

private:
  vtkSmartPointer<vtkOutputWindow> old_;
  vtkNew<MessageCollector> collector_;
};

void checkScene(const PictureScene& scene) {
  if (!scene.points) throw std::invalid_argument("points is not set");
  if (scene.panels.empty()) throw std::invalid_argument("panels is empty, must hold at least one");
  for (const PicturePanel& panel : scene.panels) {
    const std::size_t num_elements = scene.mesh ? scene.mesh->polygons.size() : scene.points->size();
    if (!panel.segments.empty() && panel.segments.size() != num_elements) {
      throw std::invalid_argument("segments holds " + std::to_string(panel.segments.size()) + " numbers, must be " +
                                  std::to_string(num_elements) + ", one per polygon or point");
    }
    if (!panel.support.empty() && panel.support.size() != scene.points->size()) {
      throw std::invalid_argument("support holds " + std::to_string(panel.support.size()) + " values, must be " +
                                  std::to_string(scene.points->size()) + ", one per point");
    }
    for (const AxisLine& axis : panel.axes) {
      if (!axis.point.allFinite() || !axis.direction.allFinite() || !(axis.direction.norm() > 0)) {
        throw std::invalid_argument("an axis is not finite or its direction is zero");
      }
    }
    for (const PlanePatch& plane : panel.planes) {
      if (!plane.normal.allFinite() || !(plane.normal.norm() > 0) || !std::isfinite(plane.offset) ||
          !plane.center.allFinite() || !(plane.half_size >= 0) || !std::isfinite(plane.half_size)) {
        throw std::invalid_argument("a plane is not finite, its normal is zero or its half_size negative");
      }
    }
  }
  if (!scene.view.allFinite() || !(scene.view.cross(scene.up).norm() > 1e-6)) {
    throw std::invalid_argument("view and up must be finite and not parallel");
  }
}

void checkSize(int width, int height) {
  for (const int edge : {width, height}) {
    if (edge < 16 || edge > 16384) {
      throw std::invalid_argument("picture edge = " + std::to_string(edge) + ", must be >= 16 and <= 16384");
    }
  }
}

/// Places the camera so that all of the panel lies inside the picture, below the label and left of the colour bar.
/// \param bar_share part of the panel's width that the colour bar takes.
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

/// Where the panels of a picture lie, row by row.
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

/// \param first_panel of the scene among those of the picture.
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
    if (!panel.label.empty()) renderer->AddActor2D(labelActor(panel.label, font_size));
    if (has_bar) {
      renderer->AddActor2D(colorBar(grid.panel_width, grid.panel_height, std::max(8, font_size * 3 / 4)));
    }
    window.AddRenderer(renderer);
  }
}

}  // namespace

Eigen::Vector3d distinctColor(std::size_t index) {
  static const Eigen::Vector3d colors[] = {{0.90, 0.62, 0.00}, {0.00, 0.45, 0.70}, {0.00, 0.62, 0.45},
                                           {0.80, 0.47, 0.65}, {0.84, 0.37, 0.00}, {0.34, 0.71, 0.91},
                                           {0.94, 0.89, 0.26}, {0.35, 0.35, 0.35}};
  return colors[index % std::size(colors)];
}

Eigen::Vector3d segmentColor(int segment) {
  if (segment < 0) return Eigen::Vector3d::Constant(0.75);
  constexpr int kNumColors = 8;  // derived: the colours of Okabe and Ito
  const double white = 1.0 - std::pow(0.65, segment / kNumColors);
  return (1.0 - white) * distinctColor(static_cast<std::size_t>(segment)) + white * Eigen::Vector3d::Ones();
}

Eigen::Vector3d cividis(double value) {
  static const std::array<std::uint32_t, 12> anchors = {0x00204D, 0x00306F, 0x2A406C, 0x48526B, 0x5E626E, 0x727374,
                                                        0x878479, 0x9E9677, 0xB6A971, 0xD0BE67, 0xEAD357, 0xFFEA46};
  const auto color = [](std::uint32_t code) -> Eigen::Vector3d {
    return Eigen::Vector3d((code >> 16) & 255, (code >> 8) & 255, code & 255) / 255.0;
  };
  const double position = (std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0) * (anchors.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(position), anchors.size() - 2);
  const double weight = position - static_cast<double>(lower);
  return (1 - weight) * color(anchors[lower]) + weight * color(anchors[lower + 1]);
}

void standUpright(PictureScene& scene, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  scene.view = turn * scene.view;
  scene.up = up;
}

void renderPicture(const PictureScene& scene, const std::string& path, int width, int height) {
  renderPicture(std::vector<PictureScene>{scene}, path, width, height, scene.num_columns);
}

void renderPicture(const std::vector<PictureScene>& scenes, const std::string& path, int width, int height,
                   int num_columns) {
  if (scenes.empty()) throw std::invalid_argument("scenes is empty, must hold at least one");
  int num_panels = 0;
  for (const PictureScene& scene : scenes) {
    checkScene(scene);
    num_panels += static_cast<int>(scene.panels.size());
  }
  checkSize(width, height);
  writeAtomically(path, [&](const std::string& temporary) {
    const PrivateDisplay display;
    const CollectedMessages messages;
    const int factor = std::max(width, height) <= kMaxSuperSampled ? 2 : 1;
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetAlphaBitPlanes(1);
    window->SetSize(factor * width, factor * height);
    const PanelGrid grid(num_panels, num_columns, factor * width, factor * height);
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
    if (!window->SupportsOpenGL()) throw InputError(path + ": cannot be drawn, the display has no OpenGL 3.2");
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
    writer->SetFileName(temporary.c_str());
    writer->Write();
    window->Finalize();
    if (!messages.firstError().empty()) {
      throw InputError(path + ": cannot be drawn, " + messages.firstError().substr(0, 200));
    }
  });
}

}  // namespace pcl_symmetry::apps
