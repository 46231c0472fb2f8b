#include "picture.h"

#include <pcl/conversions.h>
#include <pcl/features/normal_3d.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
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

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "private_display.h"
#include "shape_output.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kMaxSuperSampled = 4096;            ///< pictures up to this edge are drawn at twice their size
constexpr std::size_t kMaxShadedPoints = 200000;  ///< more points shade themselves by their density
constexpr double kViewAngle = 25.0;               ///< degrees
const Eigen::Vector3d kPlainColor(0.30, 0.38, 0.52);

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

void checkScene(const PictureScene& scene, int width, int height) {
  if (!scene.points) throw std::invalid_argument("points is not set");
  if (scene.panels.empty()) throw std::invalid_argument("panels is empty, must hold at least one");
  for (const PicturePanel& panel : scene.panels) {
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
  for (const int edge : {width, height}) {
    if (edge < 16 || edge > 16384) {
      throw std::invalid_argument("picture edge = " + std::to_string(edge) + ", must be >= 16 and <= 16384");
    }
  }
}

/// Moves the scene to the origin and to unit size: VTK's clipping planes and single-precision buffers want that.
struct Normalization {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double scale = 1;
  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const { return (point - center) * scale; }
};

Normalization normalizationOf(const PictureScene& scene) {
  Eigen::AlignedBox3d box;
  for (const pcl::PointXYZ& point : *scene.points) {
    const Eigen::Vector3d position = point.getVector3fMap().cast<double>();
    if (position.allFinite()) box.extend(position);
  }
  if (box.isEmpty()) throw InputError("nothing to draw, no point is finite");
  const double diagonal = box.diagonal().norm();
  return {box.center(), diagonal > 0 ? 1.0 / diagonal : 1.0};
}

/// \return for each point how bright it looks with a light at the camera, in [0, 1].
std::vector<double> shading(const PictureScene& scene, const Normalization& normalize) {
  std::vector<double> brightness(scene.points->size(), 1.0);
  pcl::PointCloud<pcl::PointXYZ>::Ptr finite(new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < scene.points->size(); ++i) {
    const Eigen::Vector3d position = (*scene.points)[i].getVector3fMap().cast<double>();
    if (!position.allFinite()) continue;
    const Eigen::Vector3f q = normalize(position).cast<float>();
    finite->emplace_back(q.x(), q.y(), q.z());
    index.push_back(i);
  }
  if (finite->size() < 16 || finite->size() > kMaxShadedPoints) return brightness;
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  pcl::PointCloud<pcl::Normal> normals;
  estimation.setInputCloud(finite);
  estimation.setKSearch(12);
  estimation.compute(normals);
  const Eigen::Vector3f view = scene.view.normalized().cast<float>();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const float cosine = std::abs(normals[i].getNormalVector3fMap().dot(view));
    if (std::isfinite(cosine)) brightness[index[i]] = cosine;
  }
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
    const Eigen::Vector3d base = panel.support.empty() ? kPlainColor : cividis(panel.support[i]);
    const Eigen::Vector3d color =
        (panel.support.empty() ? 0.45 + 0.75 * brightness[i] : 0.65 + 0.35 * brightness[i]) * base;
    for (int k = 0; k < 3; ++k) {
      colors->InsertNextValue(static_cast<unsigned char>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
    }
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

vtkSmartPointer<vtkActor> meshActor(const pcl::PolygonMesh& mesh, const Normalization& normalize) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  vtkNew<vtkPoints> points;
  for (const pcl::PointXYZ& vertex : vertices) {
    points->InsertNextPoint(normalize(vertex.getVector3fMap().cast<double>()).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const pcl::Vertices& polygon : mesh.polygons) {
    const bool drawable = std::all_of(polygon.vertices.begin(), polygon.vertices.end(), [&](pcl::index_t corner) {
      return corner >= 0 && static_cast<std::size_t>(corner) < vertices.size() &&
             vertices[static_cast<std::size_t>(corner)].getVector3fMap().allFinite();
    });
    if (!drawable) continue;
    cells->InsertNextCell(static_cast<vtkIdType>(polygon.vertices.size()));
    for (const pcl::index_t corner : polygon.vertices) cells->InsertCellPoint(corner);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2.0, 2.0);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.86, 0.86, 0.88);
  actor->GetProperty()->SetAmbient(0.25);
  actor->GetProperty()->SetDiffuse(0.75);
  actor->GetProperty()->SetInterpolationToFlat();
  return actor;
}

/// \return the corners of the rectangle in the plane, along the principal axes of the points' projections.
std::array<Eigen::Vector3d, 4> fittedCorners(const PlanePatch& plane, const pcl::PointCloud<pcl::PointXYZ>& points) {
  const Eigen::Vector3d normal = plane.normal.normalized(), s = normal.unitOrthogonal(), t = normal.cross(s);
  std::vector<Eigen::Vector2d> projections;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_moment = Eigen::Matrix2d::Zero();
  for (const pcl::PointXYZ& point : points) {
    const Eigen::Vector3d position = point.getVector3fMap().cast<double>();
    if (!position.allFinite()) continue;
    projections.emplace_back(s.dot(position), t.dot(position));
    mean += projections.back();
  }
  mean /= static_cast<double>(projections.size());
  for (const Eigen::Vector2d& q : projections) second_moment += (q - mean) * (q - mean).transpose();
  const Eigen::Matrix2d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(second_moment).eigenvectors();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& q : projections) box.extend(axes.transpose() * q);
  const double margin = 0.06 * box.diagonal().norm();
  box.extend(box.min() - Eigen::Vector2d::Constant(margin)).extend(box.max() + Eigen::Vector2d::Constant(margin));
  const auto corner = [&](double u, double v) -> Eigen::Vector3d {
    const Eigen::Vector2d q = axes * Eigen::Vector2d(u, v);
    return plane.offset / plane.normal.norm() * normal + q.x() * s + q.y() * t;
  };
  return {corner(box.min().x(), box.min().y()), corner(box.max().x(), box.min().y()),
          corner(box.max().x(), box.max().y()), corner(box.min().x(), box.max().y())};
}

/// \return the corners of the square of the given size around the given centre, upright as far as the plane allows.
std::array<Eigen::Vector3d, 4> squareCorners(const PlanePatch& plane, const Eigen::Vector3d& up) {
  const double length = plane.normal.norm();
  const Eigen::Vector3d normal = plane.normal / length;
  const Eigen::Vector3d center = plane.center - (normal.dot(plane.center) - plane.offset / length) * normal;
  Eigen::Vector3d v = up.normalized() - normal.dot(up.normalized()) * normal;
  if (v.norm() < 0.1) v = normal.unitOrthogonal();
  v.normalize();
  const Eigen::Vector3d u = normal.cross(v);
  const double h = plane.half_size;
  return {center - h * u - h * v, center + h * u - h * v, center + h * u + h * v, center - h * u + h * v};
}

/// As long as the points reach along it, and a tenth more.
void addAxis(vtkRenderer& renderer, const AxisLine& axis, const PictureScene& scene, const Normalization& normalize,
             double line_width) {
  const Eigen::Vector3d direction = axis.direction.normalized();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const pcl::PointXYZ& point : *scene.points) {
    if (!pcl::isXYZFinite(point)) continue;
    const double along = direction.dot(point.getVector3fMap().cast<double>() - axis.point);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  const double margin = 0.1 * (high - low);
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(normalize(axis.point + (low - margin) * direction).data());
  points->InsertNextPoint(normalize(axis.point + (high + margin) * direction).data());
  const vtkIdType ends[] = {0, 1};
  vtkNew<vtkCellArray> line;
  line->InsertNextCell(2, ends);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(line);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(axis.color.x(), axis.color.y(), axis.color.z());
  actor->GetProperty()->SetLineWidth(static_cast<float>(line_width));
  actor->GetProperty()->LightingOff();
  renderer.AddActor(actor);
}

void addPlane(vtkRenderer& renderer, const PlanePatch& plane, const PictureScene& scene, const Normalization& normalize,
              double line_width) {
  vtkNew<vtkPoints> points;
  const auto corners = plane.half_size > 0 ? squareCorners(plane, scene.up) : fittedCorners(plane, *scene.points);
  for (const Eigen::Vector3d& corner : corners) points->InsertNextPoint(normalize(corner).data());
  const vtkIdType loop[] = {0, 1, 2, 3, 0};
  vtkNew<vtkCellArray> quad, outline;
  quad->InsertNextCell(4, loop);
  outline->InsertNextCell(5, loop);
  for (const bool filled : {true, false}) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    if (filled) {
      data->SetPolys(quad);
    } else {
      data->SetLines(outline);
    }
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(plane.color.x(), plane.color.y(), plane.color.z());
    actor->GetProperty()->SetOpacity(filled ? 0.25 : 1.0);
    actor->GetProperty()->SetLineWidth(static_cast<float>(line_width));
    actor->GetProperty()->LightingOff();
    renderer.AddActor(actor);
  }
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
  const double half_height = std::tan(kViewAngle / 2 * M_PI / 180) * 0.88,
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

int numColumns(const PictureScene& scene, int width, int height) {
  const int num_panels = static_cast<int>(scene.panels.size());
  if (scene.num_columns > 0) return std::min(scene.num_columns, num_panels);
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

void addPanels(vtkRenderWindow& window, const PictureScene& scene, int width, int height) {
  const int columns = numColumns(scene, width, height);
  const int rows = (static_cast<int>(scene.panels.size()) + columns - 1) / columns;
  const int panel_width = width / columns, panel_height = height / rows;
  const double panel_pixels = std::min(panel_width, panel_height);
  const int font_size = std::max(8, static_cast<int>(std::lround(panel_pixels * 0.036)));
  const Normalization normalize = normalizationOf(scene);
  const std::vector<double> brightness = shading(scene, normalize);
  for (std::size_t i = 0; i < scene.panels.size(); ++i) {
    const PicturePanel& panel = scene.panels[i];
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    vtkNew<vtkRenderer> renderer;
    renderer->SetViewport(double(column) / columns, 1.0 - double(row + 1) / rows, double(column + 1) / columns,
                          1.0 - double(row) / rows);
    renderer->SetBackground(1, 1, 1);
    renderer->SetUseDepthPeeling(true);
    renderer->SetMaximumNumberOfPeels(16);
    renderer->SetOcclusionRatio(0.0);
    if (scene.mesh) renderer->AddActor(meshActor(*scene.mesh, normalize));
    renderer->AddActor(cloudActor(scene, panel, normalize, brightness, panel_pixels));
    for (const AxisLine& axis : panel.axes) addAxis(*renderer, axis, scene, normalize, panel_pixels / 120);
    for (const PlanePatch& plane : panel.planes) addPlane(*renderer, plane, scene, normalize, panel_pixels / 250);
    const bool has_bar = scene.show_color_bar && !panel.support.empty();
    fitCamera(*renderer, scene, double(panel_width) / panel_height, has_bar ? 0.12 : 0.0);
    if (!panel.label.empty()) renderer->AddActor2D(labelActor(panel.label, font_size));
    if (has_bar) {
      renderer->AddActor2D(colorBar(panel_width, panel_height, std::max(8, font_size * 3 / 4)));
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

void renderPicture(const PictureScene& scene, const std::string& path, int width, int height) {
  checkScene(scene, width, height);
  writeAtomically(path, [&](const std::string& temporary) {
    const PrivateDisplay display;
    const CollectedMessages messages;
    const int factor = std::max(width, height) <= kMaxSuperSampled ? 2 : 1;
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetAlphaBitPlanes(1);
    window->SetSize(factor * width, factor * height);
    addPanels(*window, scene, factor * width, factor * height);
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
